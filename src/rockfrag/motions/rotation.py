"""Components of one record: common times, rotation, and measures that do not depend on how the sensor stood.

In: two components [m/s²], perhaps a vertical one. Out: the same at common times, turned by an angle, or RotD
measures. Theory: ``docs/motions.md``; Boore (2010).
"""

import math
from collections.abc import Callable, Collection, Sequence
from dataclasses import replace

import numpy as np

from rockfrag.base.directions import in_direction
from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_number
from rockfrag.motions.processing import starting_later
from rockfrag.records.motion import Motion
from rockfrag.records.parsing.directions import azimuth_of, is_vertical

_RIGHT_ANGLE = 5.0  # degrees by which two components may be off a right angle
# directions looked in; the other half of the circle sees the same
DIRECTIONS_DEG = range(180)


def rotate(first: Motion, second: Motion, angle_deg: float) -> Motion:
    """Component of a horizontal motion in the direction ``angle_deg`` from first towards second.

    Parameters
    ----------
    first, second : perpendicular components, sampled at the same times
    angle_deg : direction [degrees]; 0 gives the first component, 90 the second

    Returns
    -------
    Motion named after the first, its provenance followed by this step.
    """
    _check_pair(first, second)
    angle = math.radians(real_number("rotate: angle_deg", angle_deg, "degrees"))
    turned = in_direction(
        first.acceleration, second.acceleration, math.cos(angle), math.sin(angle)
    )
    return first.after("rotate", turned, second=second.name, angle_deg=float(angle_deg))


def rotd(
    first: Motion, second: Motion, measure: Callable[[Motion], float], percentile: float
) -> float:
    """Percentile over all directions of a measure: RotD50 (median), RotD100 (largest), RotD00.

    Boore (2010, Bull. Seism. Soc. Am. 100(4), 1830-1835), directions in steps of one degree.

    Parameters
    ----------
    first, second : as of :func:`rotate`
    measure
        Any measure of one component, such as :func:`rockfrag.motions.pga` or
        ``lambda m: spectral_acceleration(m, 1.0)``.
    percentile : from 0 to 100

    Returns
    -------
    The value of the measure, in its unit.
    """
    percentile = real_number("rotd: percentile", percentile)
    if not 0 <= percentile <= 100:
        raise InputError(
            f"rotd: percentile must lie between 0 and 100, got {percentile}."
        )
    values = [measure(rotate(first, second, angle)) for angle in DIRECTIONS_DEG]
    return float(np.percentile(values, percentile))


def rotate_to_azimuth(first: Motion, second: Motion, azimuth_deg: float) -> Motion:
    """Component of a horizontal motion in the direction of an azimuth."""
    wanted = math.radians(
        real_number("rotate_to_azimuth: azimuth_deg", azimuth_deg, "degrees")
    )
    angles = [math.radians(azimuth(motion)) for motion in (first, second)]
    sine = math.sin(angles[1] - angles[0])
    if abs(sine) < math.cos(math.radians(_RIGHT_ANGLE)):
        raise InputError(
            f"components {first.name!r} and {second.name!r} have the azimuths "
            f"{azimuth(first):g} and {azimuth(second):g}°, which are not at a right angle."
        )
    first, other = common_time([first, second])
    # the motion x has x·e₁ = a₁ and x·e₂ = a₂; its part in the direction wanted follows of both
    parts = math.sin(angles[1] - wanted) / sine, math.sin(wanted - angles[0]) / sine
    turned = parts[0] * first.acceleration + parts[1] * other.acceleration
    full = float(azimuth_deg) % 360
    moved = first.after(
        "rotate to azimuth", turned, second=second.name, azimuth_deg=full
    )
    facts = {**moved.metadata, "component": f"{full:g}"}
    facts.pop("azimuth_deg", None)
    return replace(moved, metadata=facts)


def stronger_direction(first: Motion, second: Motion) -> Motion:
    """Component in the direction of the largest acceleration of any direction."""
    first, other = common_time([first, second])
    _check_pair(first, other)
    at = int(np.argmax(np.hypot(first.acceleration, other.acceleration)))
    angle = math.degrees(math.atan2(other.acceleration[at], first.acceleration[at]))
    return rotate(first, other, angle)


def azimuth(motion: Motion) -> float:
    """Azimuth of a component [degrees from north], stated or named by its component."""
    stated = motion.metadata.get("azimuth_deg")
    name = str(motion.metadata.get("component") or "")
    found = float(stated) if stated is not None else azimuth_of(name)
    if found is None:
        kind = (
            "a vertical one"
            if is_vertical(name)
            else f"{name!r}"
            if name
            else "not stated"
        )
        raise InputError(
            f"motion {motion.name!r}: its component is {kind}, so that its azimuth is not known; give "
            "metadata['azimuth_deg']."
        )
    return found


def _check_pair(first: Motion, second: Motion) -> None:
    """Check that two motions can be the two horizontal components of one record."""
    sizes = first.acceleration.size, second.acceleration.size
    if abs(first.dt - second.dt) > 1e-9 * first.dt or sizes[0] != sizes[1]:
        raise InputError(
            f"components {first.name!r} and {second.name!r} have {sizes[0]} and {sizes[1]} samples of "
            f"{first.dt:g} and {second.dt:g} s; bring them to one sampling and length first (common_time)."
        )
    for motion in (first, second):
        if is_vertical(str(motion.metadata.get("component") or "")):
            raise InputError(
                f"motion {motion.name!r} is a vertical component; a pair has two horizontal ones."
            )
    if first is second or np.array_equal(first.acceleration, second.acceleration):
        raise InputError(
            f"components {first.name!r} and {second.name!r} are one and the same; a pair has two."
        )


# fraction of a sampling interval within which a shift counts as one of whole samples
_WHOLE = 1e-3


def common_time(
    motions: Sequence[Motion], verticals: Collection[int] | None = None
) -> list[Motion]:
    """Components at the same times: those that all of them have, at samples of a horizontal one.

    Where all state the time of their first sample they are shifted by it, else they are taken to begin
    together. The times are those of the horizontal component of the shortest interval, which is not moved
    for a vertical. Samples between those of a motion are on the straight line between its neighbours.

    Parameters
    ----------
    motions, verticals : the components, and the places of vertical ones among them

    Returns
    -------
    The components, of equal length and interval.
    """
    # of the first samples after the earliest [s]
    starts = [0.0] * len(motions)
    stated = [motion.metadata.get("start_time") for motion in motions]
    if all(stated):
        from obspy import UTCDateTime

        times = [UTCDateTime(str(time)) for time in stated]
        starts = [float(time - min(times)) for time in times]
    if verticals is None:
        named = (str(motion.metadata.get("component") or "") for motion in motions)
        verticals = [place for place, name in enumerate(named) if is_vertical(name)]
    # whose samples the others follow
    lying = [i for i in range(len(motions)) if i not in verticals] or range(
        len(motions)
    )
    lead = min(lying, key=lambda i: motions[i].dt)
    dt = motions[lead].dt
    after = (max(starts) - starts[lead]) / dt
    first = starts[lead] + math.ceil(after - _WHOLE) * dt
    last = min(
        s + (m.acceleration.size - 1) * m.dt
        for s, m in zip(starts, motions, strict=True)
    )
    count = int(np.floor((last - first) / dt + _WHOLE)) + 1
    names = ", ".join(repr(motion.name) for motion in motions)
    if count < 2:
        raise InputError(
            f"{names}: these components have no time in common; are they of one record?"
        )
    return [
        _at(motion, first - start, dt, count)
        for start, motion in zip(starts, motions, strict=True)
    ]


def _at(motion: Motion, begin: float, dt: float, count: int) -> Motion:
    """Return ``count`` samples from ``begin`` seconds after the first, ``dt`` seconds apart."""
    shift = begin / motion.dt
    same = abs(dt - motion.dt) <= 1e-9 * dt and abs(shift - round(shift)) < _WHOLE
    if same:
        samples = motion.acceleration[round(shift) : round(shift) + count]
    else:
        # compiled, which most records need not wait for
        from rockfrag.motions.between_samples import fill_between

        samples = np.zeros(count)
        fill_between(motion.acceleration, motion.dt, begin, dt, samples)
    if same and round(shift) == 0 and samples.size == motion.acceleration.size:
        return motion
    if begin > 0:
        # who brings it to a common time once more would leave out its beginning twice
        motion = starting_later(motion, begin)
    end = (motion.acceleration.size - 1) * motion.dt - begin - (count - 1) * dt
    return motion.after(
        "common time",
        samples,
        dt,
        left_out_at_beginning_s=begin,
        left_out_at_end_s=float(f"{max(end, 0.0):.9g}"),
        interpolated=not same,
        **motion.peaks(samples),
    )
