"""How kernels become machine code, in a process and in a page (``docs/kernels.md``)."""
