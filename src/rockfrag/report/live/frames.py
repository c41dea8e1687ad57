"""Still frames of a body at three amplitudes, drawn to scale, for pages without scripts and for print."""

import math
from collections.abc import Sequence

import numpy as np
from markupsafe import Markup

from rockfrag.engines.response import Response
from rockfrag.motions.scaling import scale_to_pga
from rockfrag.records.motion import Motion
from rockfrag.report.wording import listed, number
from rockfrag.rocking import simulate
from rockfrag.system.blocks import Block, Stack, Vector

_WIDTH, _HEIGHT, _GROUND = 200, 190, 150

_FALLING = 0.7
"""Rotation at which a falling body is drawn [rad]."""


def outlines(body: Block | Stack, theta: Sequence[float]) -> list[list[Vector]]:
    """Corners of each block at rotations [rad], from the middle of the base [m]; a pedestal's first."""
    if isinstance(body, Block):
        (angle,) = theta
        pole = Vector(math.copysign(body.b, angle), 0.0)
        return [_placed(body, body, angle, pole, pole, 0.0, 0.0)]
    first, second = theta
    pedestal, statue = body.pedestal, body.contact_statue
    pole = Vector(math.copysign(pedestal.b, first), 0.0)
    side = 1 if second >= first else -1
    upper = _turned_about(body.interface_pole(side), first, pole)
    foot = Vector(side * statue.b, 0.0).turned(pedestal.lean)
    aside = body.offset - body.contact_offset
    return [
        _placed(pedestal, pedestal, first, pole, pole, 0.0, 0.0),
        _placed(body.statue, statue, second, upper, foot, pedestal.lean, aside),
    ]


def _placed(
    drawn: Block, block: Block, angle: float, at: Vector, pole: Vector, lean: float, aside: float
) -> list[Vector]:
    """Corners of a block that is turned about its pole, which stands at ``at``."""
    corners = []
    for x, y in (
        (-drawn.b, 0.0),
        (drawn.b, 0.0),
        (drawn.b, drawn.height),
        (-drawn.b, drawn.height),
    ):
        own = Vector(x, y).turned(block.lean)
        from_pole = Vector(own.x + aside, own.y).turned(lean).minus(pole).turned(angle)
        corners.append(Vector(at.x + from_pole.x, at.y + from_pole.y))
    return corners


def _turned_about(point: Vector, angle: float, pole: Vector) -> Vector:
    arm = point.minus(pole).turned(angle)
    return Vector(pole.x + arm.x, pole.y + arm.y)


def frames_svg(
    body: Block | Stack, motion: Motion, amplitudes_g: Sequence[float]
) -> tuple[Markup, str]:
    """Draw a body at its largest rotation at each amplitude, and say what becomes of it.

    Parameters
    ----------
    body
        What is shaken.
    motion
        By what.
    amplitudes_g
        Peaks of the motion [g].

    Returns
    -------
    The drawing, and its words.
    """
    tall = body.height if isinstance(body, Block) else body.pedestal.height + body.statue.height
    scale = min(120 / tall, 170 / (1.6 * tall))
    parts, words = [], []
    for place, peak in enumerate(amplitudes_g):
        response = simulate(body, scale_to_pga(motion, peak))
        theta, verdict = _moment(response)
        shift = (place + 0.5) * _WIDTH
        for block, colour in zip(
            outlines(body, theta), ("--red", "--blue")[-len(theta) :], strict=True
        ):
            points = " ".join(
                f"{shift + scale * x:.1f},{_GROUND - scale * y:.1f}" for x, y in block
            )
            parts.append(Markup('<polygon points="{}" fill="var({})"/>').format(points, colour))
        parts.append(
            Markup('<text x="{:.0f}" y="170">{} g</text><text x="{:.0f}" y="185">{}</text>').format(
                shift, number(peak, 3), shift, verdict
            )
        )
        words.append(f"at {number(peak, 3)} g it {verdict}")
    said = listed(words) + "."
    drawing = Markup(
        '<svg viewBox="0 0 {} {}" role="img" aria-label="Still frames: {}" font-size="12" text-anchor="middle" '
        'fill="var(--ink)"><line x1="0" x2="{}" y1="{}" y2="{}" stroke="var(--rule)"/>{}</svg>'
    ).format(
        _WIDTH * len(amplitudes_g), _HEIGHT, said, _WIDTH * len(amplitudes_g), _GROUND, _GROUND,
        Markup("").join(parts),
    )  # fmt: skip
    return drawing, said


def _moment(response: Response) -> tuple[list[float], str]:
    """Rotations at the moment that says most, and what becomes of the body."""
    turned = np.abs(response.theta).max(axis=1)
    if response.overturned:
        k = int(np.argmax(turned > _FALLING))
        return response.theta[k].tolist(), f"overturns at {number(response.overturning_time, 1)} s"
    k = int(turned.argmax())
    angle = number(math.degrees(float(turned[k])), 1)
    return response.theta[k].tolist(), f"rocks to {angle}°" if turned[k] > 0 else "stays at rest"
