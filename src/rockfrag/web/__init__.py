"""The simulator in a page: the kernels as WebAssembly (``build``), and the scripts that call them.

``module.js`` with the script of a module is what a page, or Node, talks to them with; Python needs none of this.
"""

from pathlib import Path

import numpy as np

from rockfrag.engines.built_in import PureRocking
from rockfrag.engines.contract import Request, Support, Wish
from rockfrag.records.motion import GroundMotion, Motion
from rockfrag.system.system import System

_FOLDER = Path(__file__).parent


def module_bytes(name: str = "integrate") -> bytes:
    """Return the bytes of a module: ``integrate``, ``ensemble``, ``ensemble-fused`` or ``space``."""
    return (_FOLDER / f"{name}.wasm").read_bytes()


def driver_text(*names: str) -> str:
    """Return the scripts of modules, which define ``rockfragKernel``, ``rockfragEnsemble``, ``rockfragSpace``."""
    return "\n".join(
        (_FOLDER / f"{part}.js").read_text(encoding="utf-8")
        for part in ("module", *(names or ("integrate",)))
    )


IN_PAGE = PureRocking("page", frozenset({Wish.TWO_BODIES, Wish.HISTORY}))
"""The module under the contract of engines, which answers in a page alone: what a page may simulate."""


def in_page(system: System) -> Support:
    """Say whether a page simulates a system under horizontal motions."""
    return IN_PAGE.supports(
        system, GroundMotion(Motion(np.zeros(1), 1.0)), Request(history=True)
    )
