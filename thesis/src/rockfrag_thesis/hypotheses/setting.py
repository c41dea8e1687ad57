"""What the hypotheses about theory are tested on, and what several of them share.

In: a study's bodies and motions. Out: what the functions of several groups share. Docs: ``docs/hypotheses.md``.
"""

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Floats
from rockfrag.base.plausible import LARGEST_PEAK
from rockfrag.motions.processing import scale_to_pga
from rockfrag.motions.response_spectra import ResponseSpectrum, response_spectrum
from rockfrag.outcomes.response import Response
from rockfrag.records.motion import Motion
from rockfrag.simulation import overturns, simulate
from rockfrag.simulation.rocking_spectra import uniform_block
from rockfrag.system.blocks import Block, Body, Stack
from rockfrag_thesis.hypotheses.evidence import PEDESTAL, THESIS_BODIES
from rockfrag_thesis.hypotheses.hypothesis import Undecidable
from rockfrag_thesis.printed_tables import uplift_accelerations

PEAKS_G = (0.3, 0.5, 0.8, 1.2)
"""Amplitudes to which the motions are scaled for the histories of the stacks [g]."""

SAMPLE = 12
"""Motions of a larger set that serve where each needs many histories, evenly spaced in its order."""

EXACT = 1e-9  # relative difference below which two computed figures are the same [-]


SIZES = np.geomspace(1.0, 8.0, 80)
"""2π/p of the blocks of a rocking spectrum [s]: heights from 0.4 to 24 m."""
PERIODS = np.geomspace(0.1, 10.0, 60)  # periods of the oscillators [s]


@dataclass(frozen=True)
class MotionSpectra:
    """Spectra of motions as recorded; each is computed when it is first asked for."""

    motions: Sequence[Motion]  # Ground motions
    alpha: Floats  # Critical angles of the blocks [rad], rising, shape (slendernesses,)
    threads: int | None  # Threads to use; the results do not depend on it
    _oscillator: dict[float, list[ResponseSpectrum]] = field(default_factory=dict)
    _rotation: dict[float, Floats] = field(default_factory=dict)

    def oscillator(self, damping: float) -> list[ResponseSpectrum]:
        """Response spectra over `PERIODS`, one per motion."""
        if damping not in self._oscillator:
            self._oscillator[damping] = [
                response_spectrum(motion, PERIODS, damping) for motion in self.motions
            ]
        return self._oscillator[damping]

    def displacement(self, damping: float) -> Floats:
        """Sd over `PERIODS`, shape (motions, periods) [m]."""
        return np.array(
            [spectrum.displacement for spectrum in self.oscillator(damping)]
        )

    def rotation(self, factor: float = 1.0) -> Floats:
        """Largest |θ|/θc over `SIZES`, shape (slendernesses, motions, sizes) [-]; infinite if it fell.

        The critical angles are ``alpha`` times the factor.
        """
        if factor not in self._rotation:
            blocks = [uniform_block(a * factor, T) for a in self.alpha for T in SIZES]
            found = overturns(blocks, self.motions, scales=[1.0], threads=self.threads)
            shape = (self.alpha.size, SIZES.size, len(self.motions))
            self._rotation[factor] = np.moveaxis(
                found.of_top("peak_rotation").reshape(shape), 2, 1
            )
        return self._rotation[factor]


@dataclass(frozen=True)
class Setting:
    """Specimens and motions, ready for the tests."""

    objects: Mapping[str, Block]  # Lone blocks by name, without the pedestal
    pedestal: Block | None  # The block named "P", if there is one
    stacks: Mapping[str, Stack]  # Stacks by name
    all_motions: Sequence[Motion]  # Ground motions, perhaps none
    # As in `rockfrag_thesis.hypotheses.hypothesis_table.theory_table`
    seed: int
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
            raise Undecidable(
                "there is no stack among the specimens and no block named P"
            )
        return dict(self.stacks)

    @cached_property
    def motions(self) -> list[Motion]:
        """Motions that shake; raises Undecidable if there is none."""
        shaking = [motion for motion in self.all_motions if motion.pga > 0]
        if not shaking:
            raise Undecidable("there is no ground motion")
        return shaking

    @property
    def sample(self) -> list[Motion]:
        """At most `SAMPLE` of the motions, evenly spaced in their order."""
        return self.motions[:: max(1, math.ceil(len(self.motions) / SAMPLE))]

    @property
    def where(self) -> str:
        """Which histories were looked at, in words."""
        more = (
            f" of {len(self.motions)}" if len(self.sample) < len(self.motions) else ""
        )
        peaks = ", ".join(f"{peak:g}" for peak in PEAKS_G)
        stacks = len(self.assemblies)
        return (
            f"stacks: {stacks}; motions: {len(self.sample)}{more}, scaled to {peaks} g"
        )

    @cached_property
    def histories(self) -> list[Response]:
        """Every stack under every motion of the sample at each amplitude of `PEAKS_G`."""
        return [
            simulate(stack, scale_to_pga(motion, peak))
            for stack in self.assemblies.values()
            for motion in self.sample
            for peak in PEAKS_G
        ]

    @cached_property
    def impacts(self) -> pd.DataFrame:
        """Impacts of all histories, a row each, as in `rockfrag.outcomes.response.Response.contact_events`."""
        found = pd.concat(
            [each.contact_events for each in self.histories], ignore_index=True
        )
        return found[found["kind"] == "impact"]

    @cached_property
    def spectra(self) -> MotionSpectra:
        """Spectra of the motions, of blocks with the specimens' slendernesses."""
        alpha = np.array(sorted(block.alpha for block in self.blocks.values()))
        return MotionSpectra(self.motions, alpha, self.threads)

    @cached_property
    def alone(self) -> dict[str, float]:
        """Least acceleration that starts each lone block (thesis eq. 2.1) [m/s²]."""
        return {
            name: uplift_accelerations(block)[1] for name, block in self.blocks.items()
        }

    @cached_property
    def rocking_mode_3(self) -> dict[str, float]:
        """Likewise each stack held together as one body (thesis eq. 2.21, 2.22) [m/s²]."""
        return {
            name: uplift_accelerations(stack)[0]
            for name, stack in self.assemblies.items()
        }

    @cached_property
    def rocking_mode_4(self) -> dict[str, float]:
        """Likewise the statue of each stack on a still pedestal (thesis eq. 2.24, 2.25) [m/s²]."""
        return {
            name: uplift_accelerations(stack)[1]
            for name, stack in self.assemblies.items()
        }

    @cached_property
    def pedestal_too(self) -> dict[str, float]:
        """Least sudden acceleration that moves each stack's pedestal under a free statue [m/s²]."""
        return {
            name: bisect(
                lambda a, stack=stack: bool(np.any(jump(stack, a).state[:3, 0] != 0)),  # type: ignore[misc]
                0.5 * self.rocking_mode_4[name],
                LARGEST_PEAK,
                1e-4,
            )
            for name, stack in self.assemblies.items()
        }


def make_setting(
    specimens: Mapping[str, Block],
    motions: Sequence[Motion],
    seed: int,
    threads: int | None = None,
    stacks: Mapping[str, Stack] | None = None,
) -> Setting:
    """Put each tower on the pedestal if no stack is given."""
    blocks = dict(specimens)
    pedestal = blocks.pop(PEDESTAL, None)
    if pedestal is not None and not stacks:
        stacks = {f"P&{name}": Stack(pedestal, block) for name, block in blocks.items()}
    return Setting(blocks, pedestal, stacks or {}, list(motions), seed, threads)


def bisect(
    happens: Callable[[float], bool], low: float, high: float, tolerance: float
) -> float:
    """Least argument at which something happens that does not at ``low`` and does at ``high``, else Undecidable.

    ``tolerance`` is the relative width of the bracket at which the search ends [-].
    """
    if happens(low) or not happens(high):
        raise Undecidable(f"no threshold lies between {low:.3g} and {high:.3g}")
    while high - low > tolerance * high:
        middle = math.sqrt(low * high)
        low, high = (low, middle) if happens(middle) else (middle, high)
    return high


def jump(body: Body, acceleration: float) -> Response:
    """Response to a ground acceleration [m/s²] that is there at once and ends after 0.15 s."""
    return simulate(body, Motion(np.full(3, acceleration), 0.05))


def moves(body: Body, acceleration: float) -> bool:
    """Whether a sudden ground acceleration [m/s²] makes any block leave its base."""
    return bool(np.any(jump(body, acceleration).state[:3] != 0))


def starts_at(body: Body, acceleration: float) -> bool:
    """Whether a simulated body starts to rock at this acceleration [m/s²] and not just below it."""
    return moves(body, acceleration * (1 + EXACT)) and not moves(
        body, acceleration * (1 - EXACT)
    )


def require_thesis_specimens(setting: Setting) -> None:
    """Raise Undecidable unless the specimens are those of which the thesis printed figures."""
    given: dict[str, Block | None] = {**setting.objects, PEDESTAL: setting.pedestal}
    lower = {
        name: (stack.lower, THESIS_BODIES[PEDESTAL])
        for name, stack in setting.stacks.items()
    }
    bodies = {
        name: (given.get(name), body) for name, body in THESIS_BODIES.items()
    } | lower
    for name, (block, body) in bodies.items():
        if block is None or not same_block(block, body):
            raise Undecidable(
                f"the printed figures are of other specimens: {name} differs"
            )


def same_block(block: Block, other: Block) -> bool:
    """Whether two blocks have the same size and mass but for rounding, and are uniform."""
    uniform = (
        block.inertia is block.cg_height is None
        and not block.cg_offset
        and not block.lean
    )
    own = (block.width, block.height, block.mass)
    wanted = (other.width, other.height, other.mass)
    return uniform and bool(np.allclose(own, wanted, rtol=1e-6))


def listed(values: Mapping[str, float], form: str = ".3f") -> str:
    """Names with their figures, for a sentence."""
    return ", ".join(f"{name} {value:{form}}" for name, value in values.items())


def below(value: float, limit: float = EXACT) -> str:
    """A difference that should be rounding: only that it is below the limit, or how large it is.

    Its digits differ between processors, and a report must not.
    """
    return f"below {limit:.0e}" if abs(value) < limit else f"{value:.1e}"
