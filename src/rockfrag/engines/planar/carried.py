"""What an isolator carries while it stands on the plate and goes with it: one coordinate, by its power series.

The displacement u of the plate obeys (``docs/holding.md``, equation 11)

    u'' = -a_h - (g + a_v) (µ sgn u' + u/R) - (k u + F)/M

with the force F of the hysteretic part of a bilinear spring and the mass M of plate and load.  The ground's
accelerations a_h and a_v are linear between two samples, so a series in time solves it to rounding.  What stands
on the plate feels a_h + u'' and a_v, as it would on the ground; its margins of rest say whether it stays.

``p`` and ``w`` are records ``BODY`` and ``WORK`` (``records.py``).

In: a state in which the plate alone moves along the ground, and a stretch of the ground's motion. Out: the state
at its end, if nothing else happens in it, and the energies of the stretch [J].
"""

import math

from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.planar.bonds import note_rest_loads
from rockfrag.engines.planar.records import TERMS
from rockfrag.engines.planar.solve import copy, look_at
from rockfrag.engines.planar.step import MOTIONS, Instant, ground_at, least_margin
from rockfrag.engines.planar.support import displacement
from rockfrag.engines.planar.walls import any_closed

NEGLIGIBLE = 1e-20
"""Coefficients over the half width at which a series ends [-]; divided by a sample's length they are speeds that
rounding hides."""


@kernel
def is_carried(p, w):
    """Whether the plate of an isolator moves, and all above stands on it and is held by nothing else."""
    if p.is_supported == 0 or w.slides[0] == 0 or p.ties > 0 or any_closed(p, w):
        return False
    stands = True
    for k in range(1, p.count):
        stands = stands and w.closed[k].all() and w.slides[k] == 0
    return stands


@kernel
def carry_along(p, w, stretch):
    """Take plate and load through a stretch, unless something else happens in it.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK``; the margins of rest in ``w.rest`` are those of this load
    stretch : a :class:`rockfrag.engines.planar.step.Stretch`

    Returns
    -------
    Whether they went through it. Then ``w.q`` and ``w.v`` are those of its end, and ``w.series`` its series; else
    ``w.q`` and ``w.v`` are as they were.
    """
    if not _fill_series(p, w, stretch):
        return False
    felt, av = 0.0, 0.0
    for quarter in range(1, 5):
        part = 0.25 * quarter
        ah, av = ground_at(stretch, part)
        felt = ah + _acceleration(w, part, stretch.length)
        turns_back = w.slides[0] * _speed(w, part, stretch.length) < 0.0
        if turns_back or not _load_stays(p, w, felt, av):
            return False
    copy(p, w.q, w.q1)
    way, speed = _way(w), _speed(w, 1.0, stretch.length)
    for k in range(p.count):
        w.q1[3 * k] += way
        w.v1[3 * k], w.v1[3 * k + 1], w.v1[3 * k + 2] = speed, 0.0, 0.0
    look_at(p, w, w.q1)
    if least_margin(p, w, w.q1, w.v1, MOTIONS) < 0.0:
        return False
    copy(p, w.q1, w.q)
    copy(p, w.v1, w.v)
    note_rest_loads(p, w, Instant(0.0, felt, av))
    return True


@kernel
def _fill_series(p, w, stretch):
    """Fill ``w.series`` with the coefficients of u in the fraction of a stretch that is gone [m].

    ``w.terms`` is their number; False if the plate swings too fast for so long a stretch.
    """
    h = stretch.length
    mass = p.weight / p.g
    rubs = w.slides[0] * p.kinetic[0]
    # what does not depend on the displacement [m/s²]
    load = stretch.ah + (p.g + stretch.av) * rubs + _force_in_the_middle(p, w) / mass
    load_rise = stretch.rise_h + stretch.rise_v * rubs
    back, back_rise = _stiffness(p, w, stretch.av), stretch.rise_v / p.dish_radius
    c = w.series
    c[0], c[1] = displacement(p, w.q), h * w.v[0]
    c[2] = -0.5 * h * h * (load + back * c[0])
    c[3] = -h * h / 6.0 * (load_rise + back * c[1] + back_rise * c[0])
    for n in range(4, TERMS):
        c[n] = -h * h / (n * (n - 1)) * (back * c[n - 2] + back_rise * c[n - 3])
        if abs(c[n]) + abs(c[n - 1]) < NEGLIGIBLE * p.size:
            w.terms = n + 1
            return True
    return False


@kernel
def _stiffness(p, w, av):
    """Acceleration that brings the plate back per displacement [1/s²]; ``av``: of the ground, upwards [m/s²]."""
    springs = p.spring_stiffness + (p.spring_rise if w.yields == 0 else 0.0)
    return (p.g + av) / p.dish_radius + springs * p.g / p.weight


@kernel
def _force_in_the_middle(p, w):
    """Force with which the hysteretic part of a spring pushes a plate without displacement back [N]."""
    if w.yields == 0:
        return -p.spring_rise * w.plastic
    return w.yields * p.spring_strength


@kernel
def _way(w):
    """Way of the plate in a stretch [m], with its series in ``w``."""
    way = 0.0
    for n in range(w.terms - 1, 0, -1):
        way += w.series[n]
    return way


@kernel
def _speed(w, part, h):
    """Speed of the plate at a fraction of a stretch of ``h`` seconds, with its series in ``w`` [m/s]."""
    found = 0.0
    for n in range(w.terms - 1, 0, -1):
        found = found * part + n * w.series[n]
    return found / h


@kernel
def _acceleration(w, part, h):
    """Acceleration of the plate at a fraction of a stretch of ``h`` seconds, with its series in ``w`` [m/s²]."""
    found = 0.0
    for n in range(w.terms - 1, 1, -1):
        found = found * part + n * (n - 1) * w.series[n]
    return found / (h * h)


@kernel
def _load_stays(p, w, ah, av):
    """Whether all above the plate rests under accelerations to the right and upwards [m/s²]."""
    # four margins of each body; those of the plate come first
    stays = True
    for row in range(4, 4 * p.count):
        margin = w.rest[row, 0] + w.rest[row, 1] * ah + w.rest[row, 2] * av
        stays = stays and margin >= 0.0
    return stays


@kernel
def swings_on(p, w):
    """Whether plate and load swing on for ever over a ground at rest, losing nothing; the stroke is noted then.

    The margins of rest in ``w.rest`` must be those of this load.
    """
    lossless = w.yields == 0 and p.kinetic[0] == 0.0
    stiffness = _stiffness(p, w, 0.0)
    if not lossless or stiffness <= 0.0:
        return False
    middle = -_force_in_the_middle(p, w) * p.g / p.weight / stiffness
    aside, speed = displacement(p, w.q) - middle, w.v[0]
    amplitude = math.sqrt(aside * aside + speed * speed / stiffness)
    w.v1[:] = 0.0
    look_at(p, w, w.q)
    for side in (-1.0, 1.0):
        copy(p, w.q, w.q1)
        for k in range(p.count):
            w.q1[3 * k] += side * amplitude - aside
        reaches = least_margin(p, w, w.q1, w.v1, MOTIONS) < 0.0
        if reaches or not _load_stays(p, w, -side * stiffness * amplitude, 0.0):
            return False
    at = p.support_number
    furthest = abs(middle) + amplitude
    w.outcome.stroke[at] = max(w.outcome.stroke[at], furthest)
    return True


@kernel
def carried_energies(p, w, stretch):
    """Energies of a stretch that plate and load went through.

    Parameters
    ----------
    p, w : records ``BODY`` and ``WORK`` after :func:`carry_along`
    stretch : the stretch

    Returns
    -------
    Work of the ground, energy lost to friction, and energy given to springs and dish [J].
    """
    mass = p.weight / p.g
    # integrals of a constant and of what rises from 0 to 1, times the speed; and of the displacement squared [m²]
    steady, rising, squared = _way(w), 0.0, 0.0
    for n in range(1, w.terms):
        rising += w.series[n] * n / (n + 1)
    for i in range(w.terms):
        for j in range(w.terms):
            squared += w.series[i] * w.series[j] / (i + j + 1)
    at_end = displacement(p, w.q)
    before, after = w.series[0] * w.series[0], at_end * at_end
    pressed = p.g + stretch.av
    work = -mass * (stretch.ah * steady + stretch.rise_h * rising)
    rubs = w.slides[0] * p.kinetic[0]
    lost = rubs * mass * (pressed * steady + stretch.rise_v * rising)
    given = (
        0.5 * (after - before) * (p.spring_stiffness + mass * pressed / p.dish_radius)
    )
    given += 0.5 * (after - squared) * mass * stretch.rise_v / p.dish_radius
    if w.yields == 0:
        middle = w.series[0] + 0.5 * steady - w.plastic
        given += p.spring_rise * middle * steady
    else:
        given += w.yields * p.spring_strength * steady
    return work, lost, given
