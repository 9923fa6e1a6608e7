"""Turn LLVM's instructions into machine code, kept on disk.

    emit(builder, *arguments)       writes the body of a function; it may return an integer

Kinds of arguments are "i8", an integer, and "f8[:]", "f8[:, :]", "i8[:]", …: arrays of doubles or integers that lie in
memory without gaps. Of an array, its address and the lengths of its axes are passed.
"""

from __future__ import annotations

import ctypes
import hashlib
import inspect
import os
import sys
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.cache import keep, recall
from linksweep.engine.kernel import instructions

INTEGER, INTEGERS, ROW, TABLE = "i8", "i8[:]", "f8[:]", "f8[:, :]"
SOURCE = inspect.getsource(sys.modules[__name__]) + instructions.SOURCE
"""All that enters the machine code besides what is asked for."""


class Array(NamedTuple):
    """An array in machine code: where it starts, and the lengths of its axes."""

    data: Any
    shape: tuple[Any, ...]


class MachineCode:
    """A function of machine code: called from Python, or by other machine code that has its `address`.

    `function` takes what is passed: of an array its address and the lengths of its axes.
    """

    def __init__(self, engine: Any, symbol: str, kinds: tuple[str, ...]) -> None:
        self.engine, self.kinds = engine, kinds  # the code lives as long as the engine
        self.address = engine.get_function_address(symbol)
        passed = sum(1 + axes(kind) for kind in kinds)
        self.function = ctypes.CFUNCTYPE(ctypes.c_int64, *[ctypes.c_int64] * passed)(self.address)

    def __call__(self, *arguments: Any) -> int:
        passed: list[int] = []
        for kind, argument in zip(self.kinds, arguments, strict=True):
            if kind == INTEGER:
                passed.append(argument)
            else:
                memory = argument.__array_interface__
                if memory["strides"] or memory["typestr"][1:] != kind[:2] or argument.ndim != axes(kind):
                    raise TypeError(f"{argument.dtype}, {argument.shape}, {argument.strides}: no array of kind {kind}")
                passed.append(memory["data"][0])
                passed += memory["shape"]
        return self.function(*passed)


def axes(kind: str) -> int:
    """Return the number of axes of an array of this kind; 0 for an integer."""
    return kind.count(":")


def address(array: np.ndarray) -> int:
    """Return where an array starts in memory."""
    return array.__array_interface__["data"][0]


def machine_code(emit: Callable[..., Any], kinds: tuple[str, ...], text: str) -> MachineCode:
    """Return the function whose body `emit` writes: kept machine code, or compiled now. `text` differs wherever the
    body does."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    processor, features = _processor(binding)
    triple = binding.Target.from_default_triple()
    target = triple.create_target_machine(processor, features, opt=3)
    made_of = f"{binding.llvm_version_info} {target.triple} {processor} {features} {SOURCE} {kinds} {text}"
    name = f"{emit.__name__.strip('_')}_{hashlib.sha256(made_of.encode()).hexdigest()[:24]}"
    code = recall(name)
    if code is None:
        code = _compiled(binding, target, emit, name, kinds)
        keep(name, code)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return MachineCode(engine, name, kinds)


def _processor(binding: Any) -> tuple[str, str]:
    """Return the processor to compile for and its features: this one, or the one that numba's settings name."""
    if name := os.environ.get("NUMBA_CPU_NAME"):
        return name, os.environ.get("NUMBA_CPU_FEATURES", "")
    return binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()


def write_call(builder: Any, function: Any, arguments: tuple[Any, ...]) -> None:
    """Write the call of machine code by its address, an integer."""
    from llvmlite import ir

    passed: list[Any] = []
    for argument in arguments:
        passed += [argument.data, *argument.shape] if isinstance(argument, Array) else [argument]
    kind = ir.FunctionType(ir.IntType(64), [x.type for x in passed])
    builder.call(builder.inttoptr(function, kind.as_pointer()), passed)


def _compiled(binding: Any, target: Any, emit: Callable[..., Any], name: str, kinds: tuple[str, ...]) -> bytes:
    module = binding.parse_assembly(str(_module(emit, name, kinds)))
    module.verify()
    passes = binding.create_pass_builder(target, binding.create_pipeline_tuning_options(speed_level=2))
    passes.getModulePassManager().run(module, passes)
    return target.emit_object(module)


def _module(emit: Callable[..., Any], name: str, kinds: tuple[str, ...]) -> Any:
    from llvmlite import ir

    integer, double = ir.IntType(64), ir.DoubleType()
    starts = {"i8": integer.as_pointer(), "f8": double.as_pointer()}
    passed: list[Any] = []
    for kind in kinds:
        passed += [integer] if kind == INTEGER else [starts[kind[:2]], *[integer] * axes(kind)]
    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(integer, passed), name)
    builder, values = ir.IRBuilder(function.append_basic_block()), iter(function.args)
    arguments: list[Any] = []
    for kind in kinds:
        value = next(values)
        arguments.append(value if kind == INTEGER else Array(value, tuple(next(values) for _ in range(axes(kind)))))
    builder.ret(emit(builder, *arguments) or integer(0))
    return module
