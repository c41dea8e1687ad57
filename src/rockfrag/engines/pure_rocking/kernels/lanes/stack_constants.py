"""Constants of a stack that its contact states fix, for lanes and contact events to look up.

In: the record of a body (``equations.BODY``) and a sampling interval [s]. Out: records ``ONE``, ``TWO`` and
``IMPACT``, one a contact state. Time is counted in samples, so lengths of time in the constants carry the
sampling interval.
Theory: ``docs/kernels.md``, "Contact states"; ``docs/derivation.md``.
"""

import math

import numpy as np

from rockfrag.base.arrays import fields, whole
from rockfrag.base.elementary import hypot
from rockfrag.engines.compile.jit import kernel
from rockfrag.engines.pure_rocking.kernels import equations
from rockfrag.engines.pure_rocking.kernels.impact import impact

HOLD = 12
"""Coefficients of the moment that closes a contact at a corner: of (1, sin θ, cos θ) θ'', (1, sin θ, cos θ) θ'²,
(1, sin θ, cos θ) of the ground, and (1, sin θ, cos θ) of gravity."""

# rows of these coefficients
OF_ROTATION, OF_ROTATION_SIN, OF_ROTATION_COS = 0, 1, 2
OF_SQUARE, OF_SQUARE_SIN, OF_SQUARE_COS = 3, 4, 5
OF_GROUND, OF_GROUND_SIN, OF_GROUND_COS = 6, 7, 8
OF_GRAVITY, OF_GRAVITY_SIN, OF_GRAVITY_COS = 9, 10, 11

ONE = np.dtype(
    [
        # first moments about the pivot times g over the moment of inertia, per sample²
        *fields("gx gy"),
        # 1 over the critical angle, positive on the side of the pivot
        *fields("per_angle"),
        *fields("per_speed"),  # (1 over critical angle, frequency and interval)²
        *fields("right left", HOLD, 1),  # corners of the closed contact
    ]
)
"""A contact state in which one rotates: the statue (pattern 4), or both blocks as one (pattern 3)."""

TWO = np.dtype(
    fields("v1x v1y v2x v2y m11 m22 e f per_angle1 per_angle2 per_speed1 per_speed2")
)
"""A contact state in which both rotate (patterns 1 and 2), with first moments v per sample²."""

IMPACT = np.dtype(
    [
        # products of the velocity fields before and after one contact of two closes
        *fields("ground both11 both12 both21 both22"),
        # landing of the one part that rocks: contacts and velocities after it at unit speed, √ of the energy left,
        # and whether the law of a measured restitution has to give way in it
        *whole("next1 next2"),
        *fields("after1 after2 fraction"),
        *whole("gives_way"),
    ]
)
"""Impacts out of a contact state."""


@kernel
def fill_constants(body, h, lanes_of_one, two, impacts, scratch):
    """Fill the constants of the nine contact states of a body for a sampling interval h [s].

    ``lanes_of_one``, ``two``, ``impacts``: records ONE, TWO and IMPACT, shape (9,) each, by
    ``equations.number_of``; ``scratch``: a STATE to work in.
    """
    hh = h * h
    for c1 in (-1, 0, 1):
        for c2 in (-1, 0, 1):
            at = equations.number_of(c1, c2)
            if c1 != 0 and c2 != 0:
                _fill_both_rotating(body, c1, c2, hh, two[at])
                _fill_closing(body, c1, c2, impacts[at])
            elif c1 != 0 or c2 != 0:
                _fill_one_rotating(body, c1, c2, hh, lanes_of_one[at])
                _fill_landing(body, c1, c2, impacts[at], scratch)


@kernel
def _fill_one_rotating(body, c1, c2, hh, lanes_of_one):
    """Fill the constants of a contact state in which one part rotates; ``hh``: step squared [s²]."""
    critical, vx, vy, inertia = equations.balance(body, c1, c2)
    for corner in (1.0, -1.0):
        hold = lanes_of_one.right if corner > 0.0 else lanes_of_one.left
        for n in range(HOLD):
            hold[n, 0] = 0.0
        if c1 != 0:
            _fill_interface_hold(body, equations.pivot(c1), corner, hh, hold)
        else:
            _fill_ground_hold(body, corner, equations.pivot(c2), hh, hold)
    per = hh * body.gravity / inertia
    lanes_of_one.gx, lanes_of_one.gy = per * vx, per * vy
    lanes_of_one.per_angle = (c1 + c2) / critical
    lanes_of_one.per_speed = 1.0 / (per * hypot(vx, vy) * critical * critical)


@kernel
def _fill_both_rotating(body, c1, c2, hh, two):
    """Fill the constants of a contact state in which both blocks rotate; ``hh``: step squared [s²]."""
    s1, s2 = equations.pivot(c1), equations.pivot(c2)
    two.m11, two.m22 = equations.inertia1(body, s1, s2), equations.inertia2(body, s2)
    two.e, two.f = equations.coupling(body, s1, s2)
    scale = hh * body.gravity
    critical, vx, vy, inertia = equations.balance(body, c1, c2)
    two.v1x, two.v1y = hh * vx, hh * vy
    two.per_angle1 = c1 / critical
    two.per_speed1 = inertia / (scale * hypot(vx, vy) * critical * critical)
    critical, vx, vy, inertia = equations.balance(body, 0, c2)
    two.v2x, two.v2y = hh * vx, hh * vy
    two.per_angle2 = c2 / critical
    two.per_speed2 = inertia / (scale * hypot(vx, vy) * critical * critical)


@kernel
def _fill_ground_hold(body, s1, s2, hh, hold):
    """Fill coefficients of the ground's moment on a standing pedestal in pattern 4 (``equations.hold``)."""
    e, f = equations.coupling(body, s1, s2)
    vx, vy = equations.first_moment1(body, s1, s2)
    # (e cos θ + f sin θ) θ'' + (f cos θ - e sin θ) θ'² + a vy - g vx
    hold[OF_ROTATION_SIN, 0], hold[OF_ROTATION_COS, 0] = s1 * f, s1 * e
    hold[OF_SQUARE_SIN, 0], hold[OF_SQUARE_COS, 0] = -s1 * e, s1 * f
    hold[OF_GROUND, 0] = s1 * hh * vy
    hold[OF_GRAVITY, 0] = -s1 * hh * body.gravity * vx


@kernel
def _fill_interface_hold(body, s1, s2, hh, hold):
    """Fill coefficients of the interface's moment on a statue that turns with its pedestal (``hold``)."""
    e, f = equations.coupling(body, s1, s2)
    vx, vy = equations.first_moment2(body, s2)
    # (e + m22) θ'' - f θ'² + a (vy cos θ - vx sin θ) - g (vx cos θ + vy sin θ)
    hold[OF_ROTATION, 0] = s2 * (e + equations.inertia2(body, s2))
    hold[OF_SQUARE, 0] = -s2 * f
    weight = s2 * hh * body.gravity
    hold[OF_GROUND_SIN, 0], hold[OF_GROUND_COS, 0] = -s2 * hh * vx, s2 * hh * vy
    hold[OF_GRAVITY_SIN, 0], hold[OF_GRAVITY_COS, 0] = -weight * vy, -weight * vx


@kernel
def _fill_closing(body, c1, c2, products):
    """Fill the kinetic products by which momentum about new pivots follows from the velocities before an impact.

    ``products.ground``: the ground's contact comes down on its other pivot, of which only K11 is needed, as the
    other products are in the mass matrices (``impact.ground_impact``); ``products.both11`` to ``both22``: the
    interface's. The other contact stays open meanwhile.
    """
    s1, s2 = equations.pivot(c1), equations.pivot(c2)
    # cosine and sine of what the statue is turned on its pedestal by: nothing where the interface closes, and K11
    # does not depend on it
    old, level = (s1, s2), (1.0, 0.0)
    products.ground, _, _, _ = equations.metric(body, (-s1, s2), old, level)
    k11, k12, k21, k22 = equations.metric(body, (s1, -s2), old, level)
    products.both11, products.both12 = k11, k12
    products.both21, products.both22 = k21, k22


@kernel
def _fill_landing(body, c1, c2, products, scratch):
    """Fill the outcome of the impact in which the one part that rocks lands, at unit speed.

    That of another speed is in proportion to it. ``scratch`` is a STATE.
    """
    scratch.c1, scratch.c2, scratch.theta1, scratch.theta2 = c1, c2, 0.0, 0.0
    scratch.omega1, scratch.omega2 = -1.0 * c1, -1.0 * (c1 + c2)
    n1, n2, w1, w2, gives_way = impact(body, scratch, c1 != 0, c2 != 0)
    before = equations.kinetic_energy(body, scratch)
    scratch.c1, scratch.c2, scratch.omega1, scratch.omega2 = n1, n2, w1, w2
    after = equations.kinetic_energy(body, scratch)
    products.next1, products.next2, products.after1, products.after2 = n1, n2, w1, w2
    products.fraction, products.gives_way = math.sqrt(after / before), gives_way
