"""Factors on motions to levels of shaking, as far as they may be scaled, and those that lift an object; compiled.

In: levels, values of motions in their measure, samples [m/s²]. Out: factors [-].
Docs: ``docs/assess.md``, "What is computed".
"""

import math

from rockfrag.assess.core.compiled import entry_kernel, kernel
from rockfrag.base.directions import in_direction
from rockfrag.base.plausible import LARGEST_PEAK
from rockfrag.base.units import GRAVITY

LARGEST_FACTOR = 10.0
"""Largest and 1/smallest factor by which a motion is scaled; beyond, its shape belongs to another earthquake."""

AT_REST = 1e-9  # Factor of motions that are not counted: at rest costs nothing


@kernel
def _believable(peak):
    """Largest factor on a motion of a peak [m/s²] with which it is still one that a floor may feel."""
    return (1.0 - 1e-9) * LARGEST_PEAK / peak if peak > 0.0 else math.inf


@entry_kernel
def fill_scales(levels, values, peaks, scales, allowed):
    """Factors to rising levels, and whether a motion may be scaled so far.

    Parameters
    ----------
    levels : of a measure, shape (levels,)
    values : of each motion in that measure, shape (motions,)
    peaks : of what shakes the object [m/s²], shape (motions,); 0 where any is believed
    scales, allowed : of each motion and level, shape (motions, levels)
    """
    for m in range(values.size):
        most = _believable(peaks[m])
        for k in range(levels.size):
            scale = levels[k] / values[m]
            scales[m, k] = scale
            inside = 1.0 / LARGEST_FACTOR <= scale <= LARGEST_FACTOR
            allowed[m, k] = inside and scale <= most


@entry_kernel
def fill_factors(scales, allowed, peaks, factors):
    """Fill factors on what shakes the object, at most those that are believed; ``AT_REST`` where none counts.

    Parameters
    ----------
    scales, allowed : factors to levels, and whether they count, shape (motions, levels)
    peaks : of what shakes the object [m/s²], shape (motions,)
    factors : filled, shape (motions, levels)
    """
    for m in range(scales.shape[0]):
        most = _believable(peaks[m])
        for k in range(scales.shape[1]):
            factors[m, k] = min(scales[m, k], most) if allowed[m, k] else AT_REST


@entry_kernel
def peak_of(samples):
    """Largest magnitude of samples, in their unit."""
    most = 0.0
    for i in range(samples.size):
        most = max(most, abs(samples[i]))
    return most


@entry_kernel
def fill_direction(first, second, cosine, sine, found):
    """Fill what two horizontal components come to in a direction, by samples, shape (n,).

    ``cosine``, ``sine``: of the angle from the first component.
    """
    for i in range(found.size):
        found[i] = in_direction(first[i], second[i], cosine, sine)


# ---- statics


@entry_kernel
def lifting_in_plane(uplift, peak):
    """Factor on a motion of a peak [m/s²] from which it opens a contact whose least acceleration is known [g]."""
    return uplift * GRAVITY / peak


@entry_kernel
def lifting_over_edges(corners, height, x, y):
    """Factor on both components from which they lift a body in space over an edge.

    Over an edge at the distance d from below the centre of gravity at height h, that takes an acceleration of the
    base away from it of g d/h.

    Parameters
    ----------
    corners : of the base, anticlockwise from below the centre of gravity [m], shape (corners, 2)
    height : of the centre of gravity [m]
    x, y : both components [m/s²], shape (n,)
    """
    most, count = 0.0, corners.shape[0]
    for i in range(count):
        here, there = corners[i], corners[(i + 1) % count]
        across, along = there[0] - here[0], there[1] - here[1]
        side = math.sqrt(across * across + along * along)
        outward, aside = along / side, -across / side
        distance = outward * here[0] + aside * here[1]
        least = GRAVITY * distance / height
        of_x, of_y = outward / least, aside / least
        for j in range(x.size):
            most = max(most, -(of_x * x[j] + of_y * y[j]))
    return 1.0 / most


@entry_kernel
def lifting_over_rim(radius, centre_x, centre_y, height, x, y):
    """Factor on both components from which they lift a body in space over a rim.

    In any direction that takes an acceleration of g r/h; a centre of gravity that is not above the middle of a rim
    lifts it earlier towards the near side, by its distance.

    Parameters
    ----------
    radius : of the rim [m]
    centre_x, centre_y : middle of the rim from below the centre of gravity [m]
    height : of the centre of gravity [m]
    x, y : both components [m/s²], shape (n,)
    """
    aside = math.sqrt(centre_x * centre_x + centre_y * centre_y)
    least = GRAVITY * (radius - aside) / height
    most = 0.0
    for j in range(x.size):
        most = max(most, math.sqrt(x[j] * x[j] + y[j] * y[j]))
    return least / most
