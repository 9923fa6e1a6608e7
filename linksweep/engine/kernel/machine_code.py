"""Turn LLVM's instructions into machine code, kept on disk.

    emit(builder, *arguments)       writes the body of a function; it may return an integer

Kinds of arguments are "i8", an integer, and "f8[:]", "f8[:, :]", "i8[:]", …: arrays of doubles or integers that lie in
memory without gaps. Of an array, its address and the lengths of its axes are passed; of "i8*" and "f8*", arrays of any
number of axes, the address alone.
"""

from __future__ import annotations

import ctypes
import hashlib
import inspect
import os
import struct
import sys
from collections.abc import Callable
from functools import cache, cached_property
from itertools import count
from typing import Any, NamedTuple

import numpy as np

from linksweep.base.cache import keep, recall
from linksweep.base.memory import without_collecting
from linksweep.engine.kernel import instructions

INTEGER, INTEGERS, ROW, TABLE = "i8", "i8[:]", "f8[:]", "f8[:, :]"
SOURCE = inspect.getsource(sys.modules[__name__]) + instructions.SOURCE
"""All that enters the machine code besides what is asked for."""
NUMBERS = {"f8": np.dtype(np.float64), "i8": np.dtype(np.int64)}
"""Kinds of numbers in arrays."""
HEADER, _integer_at = object.__basicsize__, ctypes.c_int64.from_address
"""The address of an array's memory follows the header that all objects have: numpy's C interface promises so, and
`array.ctypes` takes ten times as long."""


class Array(NamedTuple):
    """An array in machine code: where it starts, and the lengths of its axes."""

    data: Any
    shape: tuple[Any, ...]


class MachineCode:
    """A function of machine code: called from Python, or by other machine code that has its `address`.

    Other code passes of an array its address and the lengths of its axes. The code lives as long as its `owner`.
    """

    def __init__(self, owner: Any, address: int, kinds: tuple[str, ...]) -> None:
        self.owner, self.address, self.kinds = owner, address, kinds
        self.forms = [(kind, None if kind == INTEGER else NUMBERS[kind[:2]], axes(kind)) for kind in kinds]
        self.packed = struct.Struct(f"{sum(1 + axes(kind) for kind in kinds)}q")

    def __call__(self, *arguments: Any) -> int:
        passed: list[int] = []
        for argument, (kind, numbers, axes) in zip(arguments, self.forms, strict=True):
            if numbers is None:
                passed.append(argument)
                continue
            if argument.dtype != numbers or not argument.flags.c_contiguous or axes not in (0, argument.ndim):
                raise TypeError(f"{argument.dtype}, {argument.shape}, {argument.strides}: no array of kind {kind}")
            passed.append(id(argument) + HEADER)
            if axes:
                passed += argument.shape
        return self.caller(self.address, self.packed.pack(*passed))

    @cached_property
    def caller(self) -> Callable[[int, bytes], int]:
        return caller(self.kinds)


def axes(kind: str) -> int:
    """Return the number of axes of an array of this kind; 0 for an integer or an address."""
    return kind.count(":")


@cache
def caller(kinds: tuple[str, ...]) -> Callable[[int, bytes], int]:
    """Return the function that calls machine code at an address with packed arguments: of an array where its address
    lies, and the lengths of its axes. ctypes takes 15 µs to pass forty integers."""

    def call_packed(builder: Any, function: Any, packed: Any) -> Any:
        numbers = (builder.load(builder.gep(packed.data, [packed.data.type.pointee(k)])) for k in count())
        arguments: list[Any] = []
        for kind in kinds:
            number = next(numbers)
            if kind != INTEGER:
                number = builder.load(builder.inttoptr(number, packed.data.type))
                number = Array(number, tuple(next(numbers) for _ in range(axes(kind))))
            arguments.append(number)
        return write_call(builder, function, tuple(arguments))

    made = machine_code(call_packed, (INTEGER, "i8*"), f"{kinds}")
    function: Any = ctypes.CFUNCTYPE(ctypes.c_int64, ctypes.c_int64, ctypes.c_char_p)(made.address)
    function.owner = made.owner
    return function


def address(array: np.ndarray) -> int:
    """Return where an array starts in memory."""
    return _integer_at(id(array) + HEADER).value


@without_collecting()
def machine_code(emit: Callable[..., Any], kinds: tuple[str, ...], text: str) -> MachineCode:
    """Return the function whose body `emit` writes: kept machine code, or compiled now. `text` differs wherever the
    body does."""
    from llvmlite import binding

    target, name = _target(), _name(emit, kinds, text)
    code = recall(name)
    if code is None:
        code = target.emit_object(_optimised(target, emit, name, kinds))
        keep(name, code)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), target)
    engine.add_object_file(binding.ObjectFileRef.from_data(code))
    engine.finalize_object()
    return MachineCode(engine, engine.get_function_address(name), kinds)


def is_kept(emit: Callable[..., Any], kinds: tuple[str, ...], text: str) -> bool:
    """Return whether the machine code of this function is kept on disk."""
    return recall(_name(emit, kinds, text)) is not None


def _name(emit: Callable[..., Any], kinds: tuple[str, ...], text: str) -> str:
    """Return the name of a function, which covers all that enters its machine code."""
    from llvmlite import binding

    made_of = f"{binding.llvm_version_info} {_target().triple} {' '.join(processor())} {SOURCE} {kinds} {text}"
    return f"{emit.__name__.strip('_')}_{hashlib.sha256(made_of.encode()).hexdigest()[:24]}"


def _target() -> Any:
    """Return what LLVM compiles for."""
    from llvmlite import binding

    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    cpu, features = processor()
    return binding.Target.from_default_triple().create_target_machine(cpu, features, opt=3)


def processor() -> tuple[str, str]:
    """Return the processor to compile for and its features: this one, or the one that numba's settings name."""
    from llvmlite import binding

    if name := os.environ.get("NUMBA_CPU_NAME"):
        return name, os.environ.get("NUMBA_CPU_FEATURES", "")
    return binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()


def write_call(builder: Any, function: Any, arguments: tuple[Any, ...]) -> Any:
    """Write the call of a function of the module, or of machine code by its address, an integer; return its result."""
    from llvmlite import ir

    passed: list[Any] = []
    for argument in arguments:
        passed += [argument.data, *argument.shape] if isinstance(argument, Array) else [argument]
    if not isinstance(function, ir.Function):
        kind = ir.FunctionType(ir.IntType(64), [x.type for x in passed])
        function = builder.inttoptr(function, kind.as_pointer())
    return builder.call(function, passed)


def _optimised(target: Any, emit: Callable[..., Any], name: str, kinds: tuple[str, ...]) -> Any:
    """Return the module of a function for a target."""
    from llvmlite import binding, ir

    new_function(written := ir.Module(), emit, name, kinds)
    module = binding.parse_assembly(str(written))
    module.verify()
    tuning = binding.create_pipeline_tuning_options(speed_level=2)
    tuning.loop_unrolling = False  # elimination took twice as long to compile unrolled, and as long or longer to run
    passes = binding.create_pass_builder(target, tuning)
    passes.getModulePassManager().run(module, passes)
    return module


def new_function(module: Any, emit: Callable[..., Any], name: str, kinds: tuple[str, ...]) -> Any:
    """Write a function into a module; `emit` writes its body."""
    from llvmlite import ir

    integer, double = ir.IntType(64), ir.DoubleType()
    starts = {"i8": integer.as_pointer(), "f8": double.as_pointer()}
    passed: list[Any] = []
    for kind in kinds:
        passed += [integer] if kind == INTEGER else [starts[kind[:2]], *[integer] * axes(kind)]
    function = ir.Function(module, ir.FunctionType(integer, passed), name)
    builder, values = ir.IRBuilder(function.append_basic_block()), iter(function.args)
    arguments: list[Any] = []
    for kind in kinds:
        value = next(values)
        arguments.append(value if kind == INTEGER else Array(value, tuple(next(values) for _ in range(axes(kind)))))
    builder.ret(emit(builder, *arguments) or integer(0))
    return function
