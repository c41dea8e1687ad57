"""Engine of planar bodies on a base whose velocity jumps: contact kernels between the jumps, and at them.

In: cases whose motion has ``steps``, of bodies that may slide, rock and fly. Out: outcomes, or a response with a
contact event ``velocity step`` for each jump. Theory: ``docs/velocity-steps.md``: seen from the base every body
gets the velocity (-Δu, -Δw) at once; what the contacts make of it is an impact, by their laws and their static
friction.
"""

import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from itertools import product

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.engines.built_in import JUMPED
from rockfrag.engines.contract import Case, Cases
from rockfrag.engines.planar import integrate as contact
from rockfrag.engines.planar import records
from rockfrag.engines.planar.engine import (
    VELOCITY_STEP,
    ContactRun,
    Records,
    closing_of,
    described,
    write_contact,
)
from rockfrag.engines.pure_rocking.kernels.single import Shaking
from rockfrag.engines.steps import step_count
from rockfrag.engines.velocity_pieces import Jump, Piece, pieces_of
from rockfrag.outcomes.outcomes import Outcomes, empty_outcomes
from rockfrag.outcomes.response import Response

LEDGERS = ("work", "friction_loss", "impact_loss", "tied")
_LARGEST = ("peak_rotation", "peak_velocity", "peak_slip", "slid")
_COUNTED = ("flights", "impacts", "paradoxes", "several_modes", "given_way")
_LAST = ("overturned_body", "parted_contact", "leaning")
# contact events that are kept at first, of one instant, and of a part of the motion
ROOM, ROOM_OF_PART = 256, 1024


def run(cases: Cases) -> Outcomes:
    """Return the outcomes of cases, whose histories are not kept."""
    outcomes = empty_outcomes(cases.names, cases.scales, (JUMPED.name,))
    found = np.zeros(cases.shape, records.OUTCOME)
    numbers = product(*map(range, cases.shape))
    for i, m, s in numbers:
        scale = float(cases.scales[m, s])
        case = Case(cases.systems[i], cases.motions[m], scale, cases.request)
        steps = Between(case)
        for _ in steps.parts(keeps=False):
            pass
        found[i, m, s] = steps.outcome
    for i, system in enumerate(cases.systems):
        write_contact(outcomes, i, system.count, found[i], everything=True)
    return outcomes


def history(case: Case) -> Response:
    """Return the response of a case."""
    return JumpedRun(case).response()


@dataclass
class Part:
    """What a part of the motion adds to a response."""

    time: Floats  # [s], shape (n,)
    ground: Floats  # acceleration of the ground [m/s²], shape (n,)
    samples: Records  # SAMPLE, shape (n,)
    contact_events: Records  # CONTACT_EVENT
    rows: Floats  # samples, from the first of this part on, at which they happen


@dataclass
class Between:
    """A case that goes from jump to jump: its system, its state now, and what has become of it so far."""

    case: Case
    work: np.void = field(default_factory=records.working_memory)  # WORK
    # OUTCOME of all parts so far
    outcome: np.void = field(default_factory=lambda: np.zeros(1, records.OUTCOME)[0])
    forced: int = 0  # times that contacts were made to stay closed
    # energies so far by ledger [J]
    spent: dict[str, float] = field(default_factory=lambda: dict.fromkeys(LEDGERS, 0.0))

    def __post_init__(self) -> None:
        """Describe the system; at a jump what stands is held by its static friction."""
        self.body, self.state = described(self.case.system, self.case.request.g)
        self.closing = closing_of(self.case.system)
        self.at_jump = self.body.copy()
        self.at_jump["kinetic"] = self.body["static"]
        self.outcome["overturning_time"] = math.nan

    def parts(self, *, keeps: bool) -> Iterator[Part]:
        """Go through all parts; ``keeps`` samples and contact events."""
        is_first = True
        for piece in pieces_of(self.case):
            if piece.jump is not None:
                yield self._jump(piece, piece.jump, is_first=is_first)
            is_first = False
            yield self._through(piece, keeps=keeps)
            if self.outcome["overturned_body"]:
                break
        self.outcome["slip"] = self._look(self.body, 0.0, 0.0).samples["slip"][0]

    def _look(self, body: np.void, ah: float, av: float) -> Part:
        """Let contacts take up the state as it is, and no time pass; return the part, which has one sample.

        ``body``: record BODY; ``ah``, ``av``: accelerations of the ground to the right and upwards [m/s²].
        """
        still = Shaking(
            np.full(1, ah), np.full(1, av), 1.0, 1.0, substeps=1, free_samples=0
        )
        return self._integrate(body, still, rows=1, room=ROOM)

    def _integrate(
        self, body: np.void, shaking: Shaking, *, rows: int, room: int
    ) -> Part:
        """Integrate a part of the shaking from the state on, which ends at its end.

        ``rows`` samples are kept, none if 0, and ``room`` contact events; where there are more it is integrated
        again with room for all.
        """
        while True:
            kept = contact.Kept(
                np.zeros(rows, contact.SAMPLE), np.zeros(room, contact.CONTACT_EVENT)
            )
            done = contact.integrate(
                body, shaking, self.state, self.closing, kept, self.work
            )
            noted = int(self.work["noted"])
            if noted <= room or rows == 0:
                break
            room = noted
        self.state = np.array([self.work["q"], self.work["v"]])
        for name in LEDGERS if rows else ():
            kept.history[name] += self.spent[name]
        time = shaking.dt * np.arange(done, dtype=np.float64)
        ground = np.zeros(done)
        ground[: shaking.samples.size] = shaking.samples[:done]
        changes = kept.contact_events[:noted]
        at = changes["time"] / shaking.dt
        return Part(time, ground, kept.history[:done], changes, at)

    def _through(self, piece: Piece, *, keeps: bool) -> Part:
        """Integrate a part of the motion; ``keeps`` samples and contact events."""
        request = self.case.request
        steps = step_count(self.case.system, piece.dt, request.g, request.step)
        shaking = Shaking(
            piece.ground, piece.upward, 1.0, piece.dt, int(steps), piece.free
        )
        rows = piece.ground.size + piece.free if keeps else 0
        part = self._integrate(
            self.body, shaking, rows=rows, room=ROOM_OF_PART if keeps else 0
        )
        self._add(piece.begin)
        return self._placed(part, piece.begin)

    def _jump(self, piece: Piece, jump: Jump, *, is_first: bool) -> Part:
        """Give all bodies the velocity of a jump, let their contacts answer, and return what that adds.

        Seen from the base bodies get the velocity opposite to the jump; the answer of the contacts is an impact
        without an approach. ``is_first``: whether the sample before the jump is kept too.
        """
        ah, av = float(piece.ground[0]), float(piece.upward[0])
        before = self._look(self.body, ah, av).samples if is_first else None
        count, old = int(self.body["count"]), self.state[1].copy()
        # velocities of all bodies to the right, and upwards
        self.state[1, 0 : 3 * count : 3] -= jump.right
        self.state[1, 1 : 3 * count : 3] -= jump.up
        shifted = self.state[1].copy()
        part = self._look(self.at_jump, ah, av)
        contact_events = part.contact_events
        jammed = contact_events["kind"] == contact.PARADOX
        # what a jump jams has an impulse, which is its answer and no paradox
        contact_events["kind"][jammed] = contact.IMPACT
        opening = np.zeros(1, contact.CONTACT_EVENT)
        opening["kind"], opening["q"] = VELOCITY_STEP, self.state[0]
        mode, kinetic = part.samples["mode"][0], self._kinetic(shifted)
        opening["before"], opening["after"] = mode, mode
        opening["v_before"], opening["v_after"] = old, shifted
        opening["slip"] = part.samples["slip"][0]
        # what a jump adds is work of the base
        opening["energy_before"], opening["energy_after"] = kinetic, kinetic
        self.spent["work"] += kinetic - self._kinetic(old)
        self.work["outcome"]["paradoxes"] -= int(jammed.sum())
        self._add(piece.begin)
        # no step sees the rates with which bodies set out from a jump
        fastest = self.outcome["peak_velocity"][:count]
        np.maximum(fastest, np.abs(self.state[1, 2 : 3 * count : 3]), out=fastest)
        part.contact_events = np.concatenate([opening, contact_events])
        part.samples = part.samples[:0] if before is None else before
        size = part.samples.size
        part.time, part.ground = part.time[:size], part.ground[:size]
        # all of it comes after the sample before the jump, and before the next one
        part.rows = np.full(part.contact_events.size, float(size))
        return self._placed(part, piece.begin)

    def _kinetic(self, velocities: Floats) -> float:
        """Kinetic energy [J] relative to the base, of velocities, three a body, shape (3 MOST,)."""
        free = 3 * int(self.body["count"])
        inertia = 1.0 / self.body["inverse"][:free]
        return float(0.5 * (inertia * velocities[:free] ** 2).sum())

    def _placed(self, part: Part, begin: float) -> Part:
        """Return a part with its times, which begin at zero, moved to begin at an instant [s]."""
        part.time = part.time + begin
        part.contact_events["time"] += begin
        return part

    def _add(self, begin: float) -> None:
        """Add the outcome that the kernels wrote of a part that begins at an instant [s] to that so far."""
        outcome, more = self.outcome, self.work["outcome"]
        for name in _LARGEST:
            outcome[name] = np.maximum(outcome[name], more[name])
        for name in _COUNTED:
            outcome[name] += more[name]
        for name in _LAST:
            outcome[name] = more[name]
        outcome["overturning_time"] = begin + float(more["overturning_time"])
        self.forced += int(self.work["forced"])
        for name in LEDGERS:
            self.spent[name] += float(self.work[name])


class JumpedRun(ContactRun):
    """A case with jumps, with all its contact events."""

    def __init__(self, case: Case) -> None:
        steps = Between(case)
        parts = list(steps.parts(keeps=True))
        self.case, self.work, self.body = case, steps.work, steps.body
        self.history = np.concatenate([part.samples for part in parts])
        self.contact_events = np.concatenate([part.contact_events for part in parts])
        self.time = np.concatenate([part.time for part in parts])
        self.ground = np.concatenate([part.ground for part in parts])
        self.clock = np.arange(self.time.size, dtype=np.float64)
        firsts = np.cumsum([0, *(part.time.size for part in parts)])
        rows = [first + part.rows for first, part in zip(firsts, parts, strict=False)]
        self.event_clock = np.concatenate(rows)
        self.work["outcome"], self.work["forced"] = steps.outcome, steps.forced
