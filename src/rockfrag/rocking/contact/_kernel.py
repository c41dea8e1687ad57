"""How the kernels of this folder are compiled."""

from rockfrag.rocking.kernels.jit import entry_kernel, kernel

__all__ = ["entry_kernel", "kernel"]
