"""Lines that ``rockfrag simulate`` prints: outcome, largest rotations, impacts and contact events of one response.

In: a response of one or two bodies, or of one body in space. Out: lines for a screen; rotations [rad], slips and
walk [mm], times [s].
"""

import math
import re
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from rockfrag.records.motion import Motion

OF_TWO_BODIES = ("1a", "1b", "2a", "2b", "3a", "3b", "4a", "4b")
MEANING = (
    "1: both bodies rock to one side, 2: to opposite sides, 3: as one body, 4: the upper one alone; a: to the "
    "right, b: to the left"
)
"""What names of rocking modes mean."""

OF_A_COLUMN = re.compile("[0RLF]{3,}")
MEANING_IN_A_COLUMN = (
    "a letter for each body from below: 0 stands flat on the one below, R rocks on its right edge, L on its left "
    "edge, F is off it"
)

LEANS = "not overturned: it leans against a wall or hangs in a tie at the end"

LARGEST_FRICTION = 10.0  # surfaces have less; a contact that needs more parts


def _each(values: Iterable[float], form: str) -> str:
    return ", ".join(format(value, form) for value in values)


def _friction(demand: float) -> str:
    """Coefficient of friction that a contact needs [-], as far as any surface has it."""
    return f"{demand:.3f}" if demand < LARGEST_FRICTION else "none is enough"


def lines_in_plane(
    record: str, motion: Motion, peak_g: float, response: Any, *, is_loose: bool
) -> list[str]:
    """Lines on a response of planar bodies, up to the contact events.

    Parameters
    ----------
    record, motion : name of the file, and its motion as recorded
    peak_g : peak acceleration [g] with which it shakes
    response : a :class:`rockfrag.outcomes.response.Response`
    is_loose : whether friction is limited, so that bodies slide and fly

    Returns
    -------
    The lines.
    """
    samples = motion.acceleration.size
    outcome = "not overturned"
    if response.overturned:
        body, time = response.overturned_body, response.overturning_time
        outcome = f"overturned: the {body}, at {time:.3f} s"
    elif response.leaning:
        outcome = LEANS
    lines = [
        f"{record}: peak {peak_g:.4f} g, {samples} samples of {motion.dt} s",
        outcome,
        f"largest rotation [rad]: {_each(np.abs(response.theta).max(axis=0), '.5f')}",
        f"impacts: {response.impacts}",
    ]
    if is_loose:
        slips = 1000 * np.abs(response.slip).max(axis=0)
        return [*lines, f"largest slip [mm]: {_each(slips, '.1f')}"]
    lines.append(
        f"friction needed: {', '.join(map(_friction, response.friction_demand))}"
    )
    lost = response.lost_contact
    if math.isnan(lost):
        lines.append("on smoother ground it slides first; give --friction to let it")
    else:
        lines.append(
            f"at {lost:.3f} s a real body would have left the ground, and what follows is no answer; give "
            "--friction to let it fly"
        )
    return lines


def contact_event_lines(contact_events: Sequence[Any], most: int) -> list[str]:
    """Lines of the first contact events, and the number of the others.

    Parameters
    ----------
    contact_events : rows of the table of contact events
    most : number of events that are shown

    Returns
    -------
    The lines.
    """
    if not contact_events:
        return ["it never rocked"]
    lines = ["rocking modes:"]
    for row in contact_events[:most]:
        lines.append(
            f"{row['time']:9.4f} s  {row['kind']:<10} {row['from']:>4} → {row['to']}"
        )
    if len(contact_events) > most:
        lines.append(f"… and {len(contact_events) - most} more (--all-contact-events)")
    if any(row["to"] in OF_TWO_BODIES for row in contact_events):
        lines.append(MEANING)
    elif any(OF_A_COLUMN.fullmatch(row["to"]) for row in contact_events):
        lines.append(MEANING_IN_A_COLUMN)
    return lines


def lines_in_space(record: str, peaks_g: Sequence[float], response: Any) -> list[str]:
    """Lines on a body in space.

    Parameters
    ----------
    record, peaks_g : name of the file, and peaks of the components [g]
    response : a :class:`rockfrag.engines.spatial.SpatialResponse`

    Returns
    -------
    The lines.
    """
    outcome, found = "not overturned", response.outcome
    if found.overturned:
        direction = math.degrees(found.fall_direction)
        outcome = (
            f"overturned over {found.fell_over}, {direction:.0f}° from the first component towards the second, "
            f"certain at {found.certain_time:.3f} s"
        )
    elif found.leaning:
        outcome = LEANS
    return [
        f"{record}: peaks {_each(peaks_g, '.4f')} g",
        outcome,
        f"largest tilt [rad]: {found.peak_tilt:.5f}",
        f"turned about the vertical [°]: {math.degrees(found.turn):.2f}",
        f"walked [mm]: {1000 * math.hypot(*found.walk):.1f}",
        f"impacts: {found.impacts}",
    ]
