"""Engine of one body on a base whose velocity jumps: single histories between the jumps, and the jumps.

In: cases whose motion has ``steps``. Out: outcomes, or a response with a contact event ``velocity step`` for each
jump. Theory: ``docs/velocity-steps.md``: a jump (Δu, Δw) of the base changes the rate about the pivot by
m (x Δw - z Δu) / I_O, with the centre of gravity at (x, z) from it.
"""

import math
from typing import NamedTuple

import numpy as np

from rockfrag.base.arrays import Floats
from rockfrag.engines.built_in import STEPPED
from rockfrag.engines.contract import Case, Cases
from rockfrag.engines.pure_rocking.ensembles import body_record
from rockfrag.engines.pure_rocking.histories import (
    VELOCITY_STEP,
    Records,
    SingleRun,
    initial_state,
    run_integration,
    summarised,
)
from rockfrag.engines.pure_rocking.kernels import record as kept
from rockfrag.engines.pure_rocking.kernels.single import SCRATCH, Shaking
from rockfrag.engines.steps import step_count
from rockfrag.engines.velocity_pieces import Piece, pieces_of
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.outcomes.response import Response
from rockfrag.system import geometry


def run(cases: Cases) -> Outcomes:
    """Return the outcomes of cases, whose histories are not kept."""

    def summary_of(case: Case, record: np.void, start: np.void) -> np.void:
        return SteppedCase(case, record).follow(start, keeps=False).summary

    return summarised(cases, STEPPED.name, summary_of)


def history(case: Case) -> Response:
    """Return the response of a case."""
    return SteppedRun(case).response()


class Followed(NamedTuple):
    """What a case, or a part of it, has come to."""

    summary: np.void  # SUMMARY
    samples: Records  # SAMPLE, shape (n,)
    time: Floats  # instants of the samples [s], shape (n,)
    contact_events: Records  # CONTACT_EVENT
    ground: Floats  # acceleration of the ground at the samples [m/s²], shape (n,)
    upward: Floats  # likewise upwards, over gravity [-]


class SteppedCase:
    """A case of one body that goes from jump to jump; the kernels' records call a lone body the second."""

    def __init__(self, case: Case, record: np.void) -> None:
        self.case, self.record = case, record
        self.shape = case.system.shapes[0]
        self.work = np.zeros(1, SCRATCH)[0]

    def follow(self, start: np.void, *, keeps: bool) -> Followed:
        """Go through all parts of the motion from a STATE; ``keeps``: samples and contact events too."""
        state, whole, work = start, blank_summary(start), 0.0
        parts: list[Followed] = []
        for piece in pieces_of(self.case):
            if piece.jump is not None:
                state, contact_event = self._jumped(state, piece, whole)
                # what the jump adds is work of the base, not a loss of the contact
                work += float(
                    contact_event[0]["energy_after"] - contact_event[0]["energy_before"]
                )
                contact_event["energy_before"] = contact_event["energy_after"]
                whole["contact_events"] += 1
                parts.append(_jump_part(contact_event, is_first=not parts))
            found = self._through(piece, state, keeps=keeps)
            found.contact_events["time"] += piece.begin
            found.samples["work"] += work
            work += float(found.summary["work"])
            parts.append(found)
            state = self.work["state"].copy()
            add_summary(whole, found.summary, piece.begin)
            if whole["fallen"]:
                break
        whole["work"] = work
        joined = map(np.concatenate, zip(*(part[1:] for part in parts), strict=True))
        return Followed(whole, *joined)

    def _through(self, piece: Piece, state: np.void, *, keeps: bool) -> Followed:
        """Integrate a part of the motion from a STATE on; ``keeps`` as of :meth:`follow`."""
        system, request = self.case.system, self.case.request
        steps = step_count(system, piece.dt, request.g, request.step)
        shaking = Shaking(
            samples=piece.ground,
            vertical=piece.upward / request.g,
            scale=1.0,
            dt=piece.dt,
            substeps=int(steps),
            free_samples=piece.free,
        )
        samples = np.zeros(
            (piece.ground.size + piece.free) if keeps else 0, kept.SAMPLE
        )
        room, count = 0, 1024 if keeps else 0
        while True:
            room, found = count, np.zeros(count, kept.CONTACT_EVENT)
            done, summary = run_integration(
                self.record, shaking, state, samples, found, memory=self.work
            )
            count = int(summary["contact_events"])
            if count <= room or not keeps:
                break
        ground, upward = np.zeros((2, done))
        ground[: piece.ground.size] = piece.ground[:done]
        upward[: piece.upward.size] = piece.upward[:done] / request.g
        time = piece.begin + piece.dt * np.arange(done, dtype=np.float64)
        return Followed(summary, samples[:done], time, found[:count], ground, upward)

    def _jumped(
        self, state: np.void, piece: Piece, summary: np.void
    ) -> tuple[np.void, Records]:
        """Return the STATE after the jump that a piece begins with, and its contact event, an array of one.

        Parameters
        ----------
        state : STATE before the jump; rotation, rate and pivot are its theta2, omega2 and c2
        piece : part of the motion after the jump
        summary : SUMMARY, in which the friction that the jump asks is noted
        """
        assert piece.jump is not None
        theta, omega = float(state["theta2"]), float(state["omega2"])
        pivot, rate = geometry.jumped(self.shape, theta, omega, piece.jump)
        after = state.copy()
        after["omega2"], after["c2"] = rate, pivot
        if pivot:
            self._ask(pivot, theta, rate - omega, piece, summary)
        contact_event = np.zeros(1, kept.CONTACT_EVENT)
        contact_event["time"], contact_event["kind"] = piece.begin, VELOCITY_STEP
        contact_event["before"], contact_event["after"] = state, after
        contact_event["energy_before"] = self._energy(int(state["c2"]), omega)
        contact_event["energy_after"] = self._energy(pivot, rate)
        return after, contact_event

    def _energy(self, pivot: int, omega: float) -> float:
        """Kinetic energy [J] relative to the base, of rocking on a pivot (0: none) at a rate [rad/s]."""
        if not pivot:
            return 0.0
        return 0.5 * geometry.pivot_inertia(self.shape, pivot) * omega**2

    def _ask(
        self, pivot: int, theta: float, change: float, piece: Piece, summary: np.void
    ) -> None:
        """Note in a SUMMARY the friction that a jump asks, and a pull of the pivot, which pure rocking gives.

        The impulse over the mass is the change of velocity of the centre of gravity, that of the rate about the
        pivot and the jump itself.

        Parameters
        ----------
        pivot : +1 or -1
        theta : rotation [rad]
        change : of the rate [rad/s]
        piece : part of the motion after the jump
        """
        assert piece.jump is not None
        x, z = geometry.turned(*geometry.arm(self.shape, pivot), theta)
        along = z * change + piece.jump.right
        normal = -x * change + piece.jump.up
        asked = abs(along) / normal if normal > 0 else math.inf
        demand = summary["demand"]
        if along or normal:
            demand["friction2"] = max(float(demand["friction2"]), asked)
        if normal < 0 and math.isnan(summary["lost_contact"]):
            summary["lost_contact"] = piece.begin


_LARGEST = ("speed2", "ratio1", "ratio2")
_COUNTED = ("impacts", "grazings", "given_way", "contact_events")


def blank_summary(start: np.void) -> np.void:
    """SUMMARY of a history that begins with a STATE and has not moved yet."""
    found: np.void = np.zeros(1, kept.SUMMARY)[0]
    for name in ("fall_time", "lost_contact"):
        found[name] = math.nan
    for name in ("normal1", "normal2"):
        found["demand"][name] = math.inf
    found["unstable_distance"] = math.inf
    found["speed2"] = abs(float(start["omega2"]))
    return found


def _jump_part(contact_event: Records, *, is_first: bool) -> Followed:
    """What a jump adds: its ``contact_event`` and, before everything else, the sample that it begins with."""
    sample = np.zeros(1 if is_first else 0, kept.SAMPLE)
    for name in ("theta2", "omega2", "c2"):
        sample[name] = contact_event["before"][name][: sample.size]
    none = np.zeros(sample.size)
    return Followed(
        summary=blank_summary(contact_event["before"][0]),
        samples=sample,
        time=none,
        contact_events=contact_event,
        ground=none,
        upward=none,
    )


def add_summary(whole: np.void, part: np.void, begin: float) -> None:
    """Add the SUMMARY of a part that begins at an instant [s] to that of all that came before."""
    for name in _LARGEST:
        whole[name] = max(whole[name], part[name])
    for name in _COUNTED:
        whole[name] += part[name]
    whole["unstable_distance"] = min(
        whole["unstable_distance"], part["unstable_distance"]
    )
    whole["fallen"] = part["fallen"]
    whole["fall_time"] = begin + part["fall_time"]
    if math.isnan(whole["lost_contact"]):
        whole["lost_contact"] = begin + part["lost_contact"]
    demand, more = whole["demand"], part["demand"]
    for body in "12":
        asked, normal = f"friction{body}", f"normal{body}"
        demand[asked] = max(demand[asked], more[asked])
        demand[normal] = min(demand[normal], more[normal])


class SteppedRun(SingleRun):
    """A case with jumps, with all its contact events."""

    def __init__(self, case: Case) -> None:
        self.system, self.count = case.system, case.system.count
        self.record = body_record(case.system, g=case.request.g)
        found = SteppedCase(case, self.record).follow(
            initial_state(case.system), keeps=True
        )
        self.summary, self.history = found.summary, found.samples
        self.contact_events, self.time = found.contact_events, found.time
        self._ground = found.ground, found.upward

    def ground(self, count: int) -> tuple[Floats, Floats]:
        """Acceleration of the ground at the samples [m/s²], and upwards over gravity."""
        right, up = self._ground
        return right[:count], up[:count]
