"""Turn LLVM's instructions into machine code, kept on disk, without numba: in a tenth of the time that it takes.

    emit(builder, *arguments)       writes the body of a function; an array is a struct with `data` and `shape`

The kinds of arguments are `ROW`, an array of doubles, `TABLE`, a contiguous one of two axes, `INTEGERS`, an array of
integers, and `INTEGER`.
"""

from __future__ import annotations

import ctypes
import hashlib
import inspect
import os
import sys
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from linksweep.base.cache import keep, recall
from linksweep.engine.kernel import instructions

ROW, TABLE, INTEGERS, INTEGER = "row", "table", "integers", "integer"
SOURCE = inspect.getsource(sys.modules[__name__]) + instructions.SOURCE
"""All that enters the machine code besides what is asked for."""


class MachineCode:
    """A function of machine code: called from Python, or by numba-compiled code that has its `address`, or that is
    linked by its `symbol`.

    `function` takes what is passed: of an array the address, of a `TABLE` also the length of its second axis.
    """

    def __init__(self, engine: Any, symbol: str, kinds: tuple[str, ...]) -> None:
        self.engine, self.symbol, self.kinds = engine, symbol, kinds  # the code lives as long as the engine
        self.address = engine.get_function_address(symbol)
        self.function = ctypes.CFUNCTYPE(None, *[ctypes.c_int64] * len(_passed(kinds)))(self.address)

    def __call__(self, *arguments: Any) -> None:
        passed: list[int] = []
        for kind, argument in zip(self.kinds, arguments, strict=True):
            passed.append(argument if kind == INTEGER else address(argument))
            passed += argument.shape[1:] if kind == TABLE else ()
        self.function(*passed)


def address(array: np.ndarray) -> int:
    return array.__array_interface__["data"][0]


def _passed(kinds: tuple[str, ...]) -> list[str]:
    """Return the kinds of what is passed for arguments."""
    return [passed for kind in kinds for passed in ([ROW, INTEGER] if kind == TABLE else [kind])]


def machine_code(emit: Callable[..., None], kinds: tuple[str, ...], text: str) -> MachineCode:
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
    made = MachineCode(engine, name, kinds)
    binding.add_symbol(name, made.address)
    return made


def _processor(binding: Any) -> tuple[str, str]:
    """Return the processor to compile for and its features: this one, or the one that numba's settings name."""
    if name := os.environ.get("NUMBA_CPU_NAME"):
        return name, os.environ.get("NUMBA_CPU_FEATURES", "")
    return binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()


def write_call(builder: Any, function: Any, *arguments: Any) -> None:
    """Write the call of machine code, by its symbol or by an integer that is its address."""
    from llvmlite import ir

    passed = []
    for argument in arguments:
        if hasattr(argument, "data"):
            passed.append(argument.data)
            passed += [builder.extract_value(argument.shape, axis) for axis in range(1, argument.shape.type.count)]
        else:
            passed.append(argument)
    kind = ir.FunctionType(ir.VoidType(), [x.type for x in passed])
    if isinstance(function, str):
        function = builder.module.globals.get(function) or ir.Function(builder.module, kind, function)
    else:
        function = builder.inttoptr(function, kind.as_pointer())
    builder.call(function, passed)


def _compiled(binding: Any, target: Any, emit: Callable[..., None], name: str, kinds: tuple[str, ...]) -> bytes:
    module = binding.parse_assembly(str(_module(emit, name, kinds)))
    module.verify()
    passes = binding.create_pass_builder(target, binding.create_pipeline_tuning_options(speed_level=2))
    passes.getModulePassManager().run(module, passes)
    return target.emit_object(module)


def _module(emit: Callable[..., None], name: str, kinds: tuple[str, ...]) -> Any:
    from llvmlite import ir

    integer, double = ir.IntType(64), ir.DoubleType()
    types = {ROW: double.as_pointer(), INTEGERS: integer.as_pointer(), INTEGER: integer}
    module = ir.Module()
    function = ir.Function(module, ir.FunctionType(ir.VoidType(), [types[kind] for kind in _passed(kinds)]), name)
    builder, passed = ir.IRBuilder(function.append_basic_block()), iter(function.args)

    def argument(kind: str) -> Any:
        value = next(passed)
        if kind == INTEGER:
            return value
        shape = ir.ArrayType(integer, 2)(ir.Undefined)
        shape = builder.insert_value(shape, next(passed), 1) if kind == TABLE else shape
        return SimpleNamespace(data=value, shape=shape)

    emit(builder, *map(argument, kinds))
    builder.ret_void()
    return module
