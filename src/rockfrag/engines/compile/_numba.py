"""Numba's private parts: a compiler that optimises an entry kernel and all that it calls in one go.

Read by :mod:`rockfrag.engines.compile.jit` alone, with versions of numba that it knows.
"""

from collections.abc import Iterator
from contextlib import contextmanager
from graphlib import TopologicalSorter
from typing import Any, ClassVar

import llvmlite.binding as llvm
from numba import _dynfunc  # type: ignore[attr-defined]
from numba.core import typed_passes, untyped_passes
from numba.core.cgutils import normalize_ir_text
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.compiler_lock import global_compiler_lock
from numba.core.targetconfig import ConfigStack
from numba.core.types.functions import Dispatcher
from numba.core.types.misc import unliteral


class Part(JITCodeLibrary):
    """The code of one kernel, not optimised and not made machine code of, with references to those it calls."""

    def add_ir_module(self, module: Any) -> None:
        """Take the kernel's code, which is all that there is."""
        self._final_module = llvm.parse_assembly(normalize_ir_text(str(module)))
        self._final_module.name = module.name

    def add_linking_library(self, library: Any) -> None:
        """Remember a kernel that is called; whoever links this one links it too."""
        self._linking_libraries.append(library)

    def finalize(self) -> None:
        """Leave the code unoptimised, for others to link."""
        for function in self._final_module.functions:
            if (
                not function.is_declaration
                and function.linkage == llvm.Linkage.external
            ):
                # may be there many times, and vanish where it is inlined
                function.linkage = "linkonce_odr"
        self._finalized = True

    def _get_module_for_linking(self) -> Any:
        self._ensure_finalized()
        return self._final_module


class Whole(JITCodeLibrary):
    """The code of an entry kernel and of all parts that it needs, each linked once."""

    def _optimize_functions(self, module: Any) -> None:
        """Leave optimising to the passes over the whole."""

    def _optimize_final_module(self) -> None:
        """Optimise once: what numba does before that looks for reference counts, of which there are none."""
        passes, builder = self._codegen._module_pass_manager()
        passes.run(self._final_module, builder)

    def finalize(self) -> None:
        """Link callers before those they call: code that nothing linked so far calls would be dropped."""
        self._linking_libraries = _callers_first(self._linking_libraries)
        super().finalize()

    def _verify_declare_only_symbols(self) -> None:
        """Refuse code that calls a function which is not there; numba asks this of its own functions alone."""
        for function in self._final_module.functions:
            if function.is_declaration and function.name.startswith("_ZN"):
                raise AssertionError(f"{function.name} is called but not linked")


def _callers_first(libraries: list[Any]) -> list[Any]:
    """Order libraries and all that their parts call, directly or not, so that each comes after its callers."""
    calls: dict[Any, list[Any]] = {}
    left = list(libraries)
    while left:
        library = left.pop()
        if library not in calls:
            library._ensure_finalized()
            calls[library] = (
                library._linking_libraries if isinstance(library, Part) else []
            )
            left += calls[library]
    return [*TopologicalSorter(calls).static_order()][::-1]


class LowerPart(typed_passes.NativeLowering):
    """Make a kernel known to those that call it, without machine code."""

    _name = "lower_part"

    def run_pass(self, state: Any) -> bool:
        """Lower the kernel."""
        state.flags.no_compile = True
        super().run_pass(state)
        made = state["cr"]
        function = _dynfunc.make_function(
            made.fndesc.lookup_module(),
            made.fndesc.qualname,
            "kernel",
            0,
            made.env,
            (state.library,),
        )
        state["cr"] = made._replace(cfunc=function)
        state.targetctx.insert_user_function(function, made.fndesc, [state.library])
        return True


@contextmanager
def _plain_types() -> Iterator[None]:
    """Compile kernels for numbers as such, not anew for each number that is written out where one is called.

    The compiler's lock is held meanwhile.
    """
    dispatcher: Any = Dispatcher
    find = dispatcher.get_call_type

    def get_call_type(kernel: Any, context: Any, args: Any, named: Any) -> Any:
        plain = {name: unliteral(kind) for name, kind in named.items()}
        return find(kernel, context, tuple(map(unliteral, args)), plain)

    dispatcher.get_call_type = get_call_type
    try:
        yield
    finally:
        dispatcher.get_call_type = find


class _KernelCompiler(CompilerBase):
    """The passes that kernels need."""

    library: ClassVar[type]
    lowering: ClassVar[type]

    def _compile_core(self) -> Any:
        """Take the kernel through its passes, without what numba works out between them for others."""
        state = self.state
        state.library = self.library(
            state.targetctx.codegen(), state.func_id.func_qualname
        )
        state.library.enable_object_caching()
        state.type_annotation = None
        with _plain_types(), ConfigStack().enter(state.flags.copy()):
            for kind in (
                untyped_passes.TranslateByteCode,
                untyped_passes.FixupArgs,
                untyped_passes.IRProcessing,
                # tuple[0] is then a part of the tuple, not a function of tuple and index to be compiled
                untyped_passes.GenericRewrites,
                untyped_passes.ReconstructSSA,
                typed_passes.NopythonTypeInference,
                typed_passes.PreLowerStripPhis,
                self.lowering,
                typed_passes.NoPythonBackend,
            ):
                kind().run_pass(state)
        return state.cr


class PartCompiler(_KernelCompiler):
    """Compiles kernels that only kernels call."""

    library = Part
    lowering = LowerPart


class WholeCompiler(_KernelCompiler):
    """Compiles kernels that Python calls."""

    library = Whole
    lowering = typed_passes.NativeLowering


def whole_ir(kernel: Any, types: tuple[Any, ...]) -> tuple[str, str]:
    """Return the code of a kernel for arguments of numba's ``types``, not optimised, and its name there.

    Parameters
    ----------
    kernel : an entry kernel
    types : of its arguments

    Returns
    -------
    The code as LLVM's text, and the name of the kernel in it.
    """
    kernel.compile(types)
    (compiled,) = kernel.overloads.values()
    entry = compiled.fndesc.llvm_func_name
    with global_compiler_lock:
        parts = _callers_first([compiled.library])
    whole = llvm.parse_assembly("")
    # else nothing calls it, and linking would drop it
    compiled.library._final_module.get_function(entry).linkage = "external"
    for part in parts:
        whole.link_in(part._final_module, preserve=True)
    return str(whole), entry
