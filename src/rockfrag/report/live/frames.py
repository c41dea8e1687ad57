"""Still frames of a body at three amplitudes, drawn to scale, for pages without scripts and for print."""

import math
from collections.abc import Sequence

import numpy as np
from markupsafe import Markup

from rockfrag.engines.response import Response
from rockfrag.motions.processing import scale_to_pga
from rockfrag.records.motion import Motion
from rockfrag.rocking import simulate
from rockfrag.sentences import listed, number
from rockfrag.system.blocks import Vector
from rockfrag.system.body import RigidBody
from rockfrag.system.system import System

_WIDTH, _HEIGHT, _GROUND = 200, 190, 150

_FALLING = 0.7
"""Rotation at which a falling body is drawn [rad]."""


def outlines(system: System, theta: Sequence[float]) -> list[list[Vector]]:
    """Corners of each of one or two bodies at rotations [rad], from the middle of the base [m]; from below."""
    bodies, tilts = system.in_plane().bodies, [contact.tilt for contact in system.contacts]
    first = theta[0]
    pivot = Vector(math.copysign(system.shapes[0].b, first), 0.0)
    corners = [[_turned_about(at, first, pivot) for at in _corners(bodies[0], tilts[0])]]
    if system.count == 2:
        pile, second = system.pile, theta[1]
        side = 1 if second >= first else -1
        foot = Vector(side * pile.upper.b, 0.0).turned(pile.lean)
        upper = _turned_about(Vector(*(pile.right if side > 0 else pile.left)), first, pivot)
        aside = Vector(pile.above.x - pile.upper.x, 0.0)
        rest = [at.minus(aside).turned(pile.lean) for at in _corners(bodies[1], tilts[1])]
        corners.append([_turned_about(at, second, foot, upper) for at in rest])
    return corners


def _corners(body: RigidBody, tilt: float) -> list[Vector]:
    """Corners of the box around a body as it stands, from the middle of its base [m]."""
    half, tall = body.width / 2, body.height
    box = ((-half, 0.0), (half, 0.0), (half, tall), (-half, tall))
    return [Vector(*corner).turned(tilt) for corner in box]


def _turned_about(point: Vector, angle: float, pivot: Vector, to: Vector | None = None) -> Vector:
    """Turn a point about a pivot, which goes to another place if one is given."""
    x, y = point.minus(pivot).turned(angle)
    at = to or pivot
    return Vector(at.x + x, at.y + y)


def frames_svg(system: System, motion: Motion, amplitudes_g: Sequence[float]) -> tuple[Markup, str]:
    """Draw a system at its largest rotation under a motion of each peak [g]; return the drawing and its words."""
    tall = system.height
    scale = min(120 / tall, 170 / (1.6 * tall))
    parts, words = [], []
    for place, peak in enumerate(amplitudes_g):
        response = simulate(system, scale_to_pga(motion, peak))
        theta, outcome = _moment(response)
        shift = (place + 0.5) * _WIDTH
        colours = ("--red", "--blue")[-len(theta) :]
        for block, colour in zip(outlines(system, theta), colours, strict=True):
            places = (f"{shift + scale * x:.1f},{_GROUND - scale * y:.1f}" for x, y in block)
            polygon = Markup('<polygon points="{}" fill="var({})"/>')
            parts.append(polygon.format(" ".join(places), colour))
        text = Markup('<text x="{0:.0f}" y="170">{1} g</text><text x="{0:.0f}" y="185">{2}</text>')
        parts.append(text.format(shift, number(peak, 3), outcome))
        words.append(f"at {number(peak, 3)} g it {outcome}")
    said = listed(words) + "."
    drawing = Markup(
        '<svg viewBox="0 0 {0} {1}" role="img" aria-label="Still frames: {2}" font-size="12" text-anchor="middle" '
        'fill="var(--ink)"><line x1="0" x2="{0}" y1="{3}" y2="{3}" stroke="var(--rule)"/>{4}</svg>'
    )
    about = (_WIDTH * len(amplitudes_g), _HEIGHT, said, _GROUND, Markup("").join(parts))
    return drawing.format(*about), said


def _moment(response: Response) -> tuple[list[float], str]:
    """Rotations at the moment that says most, and what becomes of the body."""
    turned = np.abs(response.theta).max(axis=1)
    if response.overturned:
        k = int(np.argmax(turned > _FALLING))
        return response.theta[k].tolist(), f"overturns at {number(response.overturning_time, 1)} s"
    k = int(turned.argmax())
    angle = number(math.degrees(float(turned[k])), 1)
    return response.theta[k].tolist(), f"rocks to {angle}°" if turned[k] > 0 else "stays at rest"
