"""The simulator in a page: the kernel of one history as WebAssembly, and the script that calls it.

``integrate.wasm`` is made from the kernels (``build``) and kept with the package; ``integrate.js`` is what a
page, or Node, talks to it with.  Nothing of this is needed to compute in Python.
"""

from pathlib import Path

_FOLDER = Path(__file__).parent


def module_bytes() -> bytes:
    """Return the bytes of the module."""
    return (_FOLDER / "integrate.wasm").read_bytes()


def driver_text() -> str:
    """Return the script: plain text that defines ``async function rockfragKernel(bytes)``."""
    return (_FOLDER / "integrate.js").read_text(encoding="utf-8")
