"""What the checks of theory work on, and thresholds that several of them share."""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from rockfrag.records.motion import Motion
from rockfrag.rocking import Block, Body, Response, Stack, simulate
from rockfrag.thesis.specimens import THESIS_BODIES
from rockfrag.thesis.statements.evidence import Undecidable
from rockfrag.units import STANDARD_GRAVITY

Floats = NDArray[np.float64]
FreeRocking = Mapping[str, tuple[ArrayLike, ArrayLike]]

PEAKS_G = (0.3, 0.5, 0.8, 1.2)
"""Amplitudes to which the motions are scaled for the histories of the stacks [g]."""

EXACT = 1e-9
"""Relative difference below which two computed figures are the same [-]."""


@dataclass(frozen=True)
class Setting:
    """Specimens and motions, ready for the checks.

    Attributes
    ----------
    towers
        Lone blocks by name, without the pedestal.
    stacks
        Stacks by name.
    all_motions
        Ground motions, perhaps none.
    seed, free_rocking, threads
        As in `rockfrag.thesis.statements.theory.theory_claims`.
    """

    objects: Mapping[str, Block]
    pedestal: Block | None
    stacks: Mapping[str, Stack]
    all_motions: Sequence[Motion]
    seed: int
    free_rocking: FreeRocking | None
    threads: int | None

    @property
    def blocks(self) -> dict[str, Block]:
        """Lone blocks; raises Undecidable if there is none."""
        if not self.objects:
            raise Undecidable("there is no lone block among the specimens")
        return dict(self.objects)

    @property
    def assemblies(self) -> dict[str, Stack]:
        """Stacks; raises Undecidable if there is none."""
        if not self.stacks:
            raise Undecidable("there is no stack among the specimens and no block named P")
        return dict(self.stacks)

    @property
    def motions(self) -> list[Motion]:
        """Motions that shake; raises Undecidable if there is none."""
        shaking = [one for one in self.all_motions if one.pga > 0]
        if not shaking:
            raise Undecidable("there is no ground motion")
        return shaking

    @cached_property
    def histories(self) -> list[Response]:
        """Every stack under every motion at each amplitude of `PEAKS_G`."""
        return [
            simulate(stack, one.acceleration * (peak * STANDARD_GRAVITY / one.pga), one.dt)
            for stack in self.assemblies.values()
            for one in self.motions
            for peak in PEAKS_G
        ]

    @cached_property
    def alone(self) -> dict[str, float]:
        """Acceleration at which each lone block starts to rock, by bisection of simulations [m/s²]."""
        return {name: uplift_threshold(block) for name, block in self.blocks.items()}

    @cached_property
    def pattern_4(self) -> dict[str, float]:
        """Likewise for each stack, which starts in pattern 4 if its statue is the first to move."""
        return {name: uplift_threshold(stack) for name, stack in self.assemblies.items()}

    @cached_property
    def pattern_3(self) -> dict[str, float]:
        """Likewise for each stack held together as one body."""
        return {name: uplift_threshold(stack.glued()) for name, stack in self.assemblies.items()}


def make_setting(
    specimens: Mapping[str, Body],
    motions: Sequence[Motion],
    seed: int,
    free_rocking: FreeRocking | None = None,
    threads: int | None = None,
) -> Setting:
    """Sort the specimens, and put each tower on the pedestal if no stack is given."""
    blocks = {name: body for name, body in specimens.items() if isinstance(body, Block)}
    stacks = {name: body for name, body in specimens.items() if isinstance(body, Stack)}
    pedestal = blocks.pop("P", None)
    if pedestal is not None and not stacks:
        stacks = {f"P&{name}": Stack(pedestal, block) for name, block in blocks.items()}
    return Setting(blocks, pedestal, stacks, list(motions), seed, free_rocking, threads)


def bisect(
    happens: Callable[[float], bool], low: float, high: float, tolerance: float = 1e-12
) -> float:
    """Least argument at which something happens that does not at ``low`` and does at ``high``.

    Parameters
    ----------
    tolerance
        Relative width of the bracket at which the search ends [-].

    Raises
    ------
    Undecidable
        If it happens at ``low`` already, or not even at ``high``.
    """
    if happens(low) or not happens(high):
        raise Undecidable(f"no threshold lies between {low:.3g} and {high:.3g}")
    while high - low > tolerance * high:
        middle = math.sqrt(low * high)
        if not low < middle < high:
            break
        low, high = (low, middle) if happens(middle) else (middle, high)
    return high


def jump(body: Body, acceleration: float) -> Response:
    """Response to a ground acceleration [m/s²] that is there at once and ends after 0.15 s."""
    return simulate(body, np.full(3, acceleration), 0.05)


def uplift_threshold(body: Body, pedestal: bool = False) -> float:
    """Least sudden acceleration at which anything (or the pedestal) leaves its base [m/s²]."""
    column = 0 if pedestal or isinstance(body, Block) else slice(None)
    return bisect(
        lambda a: bool(np.any(jump(body, a).state[:3, column] != 0)), 0.06, 10 * STANDARD_GRAVITY
    )


def require_thesis_specimens(setting: Setting) -> None:
    """Raise Undecidable unless the specimens are those of which the thesis printed figures."""
    given: dict[str, Block] = dict(setting.objects)
    if setting.pedestal is not None:
        given["P"] = setting.pedestal
    for name, body in THESIS_BODIES.items():
        if name not in given or not same_block(given[name], body):
            raise Undecidable(f"the printed figures are of other specimens: {name} differs")
    for name, stack in setting.stacks.items():
        if not same_block(stack.pedestal, THESIS_BODIES["P"]):
            raise Undecidable(f"the printed figures are of other specimens: {name} differs")


def same_block(one: Block, other: Block) -> bool:
    """Whether two blocks have the same size and mass but for rounding, and are uniform."""
    uniform = one.inertia is None and one.cg_height is None and not one.cg_offset and not one.lean
    return uniform and bool(
        np.allclose(
            (one.width, one.height, one.mass), (other.width, other.height, other.mass), rtol=1e-6
        )
    )


def listed(values: Mapping[str, float], form: str = ".3f") -> str:
    """Names with their figures, for a sentence."""
    return ", ".join(f"{name} {value:{form}}" for name, value in values.items())


def wilson(count: int, total: int, z: float = 1.959964) -> tuple[float, float]:
    """Limits of a share by Wilson's score, 95 % unless ``z`` says otherwise [-]."""
    share = count / total
    centre = (share + z**2 / (2 * total)) / (1 + z**2 / total)
    half = z * math.sqrt(share * (1 - share) / total + z**2 / (4 * total**2)) / (1 + z**2 / total)
    return max(0.0, centre - half), min(1.0, centre + half)
