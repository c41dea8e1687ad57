"""How the kernels of this folder are compiled."""

from rockfrag.engines.kernels.jit import entry_kernel, kernel

__all__ = ["entry_kernel", "kernel"]
