"""The simulation of bodies in space in a page: the kernel itself, and what it needs."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from markupsafe import Markup

from rockfrag.base.units import GRAVITY
from rockfrag.records.motion import GroundMotion
from rockfrag.report.live import live_texts, samples_text
from rockfrag.report.page import TEMPLATES, json_text, scripts_of, zipped_text
from rockfrag.system.blocks import Block
from rockfrag.system.body import Circle, RigidBody
from rockfrag.system.system import System
from rockfrag.web import driver_text, module_bytes
from rockfrag.words.catalogue import Catalogue, catalogue

AMPLITUDES_G = tuple(np.geomspace(0.05, 2.0, 60).tolist())
"""Amplitudes [g] that are tried in the page."""

# times of all motions that a page carries: half a megabyte of two components
MOST_SAMPLES = 30_000


@dataclass(frozen=True)
class Standing:
    """A body in space as a page shows it: the system, and what it stands on if that stays where it is."""

    system: System
    pedestal: Block | None = None


def live_in_space(
    bodies: Mapping[str, Standing],
    motions: Sequence[GroundMotion],
    left_out: Sequence[str] = (),
    texts: Catalogue | None = None,
) -> Markup:
    """Element of a page in which bodies in space rock under motions, live; one to a page.

    It shows bodies and motions by name and loads nothing; no more motions are taken than have ``MOST_SAMPLES``
    times, the first ones, at least one. ``left_out`` names what is not shown.

    Parameters
    ----------
    bodies, motions : by the names that the page shows, and what shakes them
    left_out : names of bodies that are not shown
    texts : of the page's language, the first one if None

    Returns
    -------
    HTML.
    """
    total = np.cumsum([motion.x.acceleration.size for motion in motions])
    kept = motions[: max(1, int((total <= MOST_SAMPLES).sum()))]
    say = live_texts(texts or catalogue())
    missing = say["not_in_space"].format(names=", ".join(left_out)) if left_out else ""
    data = {
        "texts": say,
        "module": zipped_text(module_bytes("space")),
        "bodies": [_body(name, body) for name, body in bodies.items()],
        "motions": [_motion(motion) for motion in kept],
        "amplitudes": AMPLITUDES_G,
    }
    return Markup(
        TEMPLATES.get_template("live_space.html.j2").render(
            say=say,
            left_out=missing,
            pedestal=any(body.pedestal for body in bodies.values()),
            data=json_text(data),
            driver=Markup(driver_text("space")),
            script=scripts_of("canvas", "view", "live_space"),
        )
    )


def peak_of(motion: GroundMotion) -> float:
    """Peak of a motion [m/s²]: of its horizontal components, in the geometric mean."""
    level = [
        component.pga for component in (motion.x, motion.y) if component is not None
    ]
    return float(np.prod(level) ** (1 / len(level)))


def _body(name: str, standing: Standing) -> dict[str, Any]:
    """A body as the driver takes it, and its sizes where it is a box or a cylinder."""
    body, below = standing.system.bodies[0], standing.pedestal
    solid: dict[str, Any] = {
        "mass": body.mass, "centre": body.centre, "tensor": body.tensor.tolist(),
    }  # fmt: skip
    if isinstance(body.base, Circle):
        solid["rim"] = {"radius": body.base.radius, "centre": body.base.centre}
    else:
        solid["vertices"] = body.base.vertices  # type: ignore[union-attr]
    return {
        "name": name,
        "solid": solid,
        "height": body.height,
        "round": "rim" in solid,
        "sizes": _sizes(body),
        "pedestal": None
        if below is None
        else {"width": below.width, "height": below.height},
    }


def _sizes(body: RigidBody) -> dict[str, Any] | None:
    """Width, depth, and turn about the vertical of a box or cylinder, and what else is typed; None of others."""
    turn = 0.0
    if isinstance(body.base, Circle):
        width, depth = 2 * body.base.radius, 2 * body.base.radius
    else:
        base = np.array(body.base.vertices)  # type: ignore[union-attr]
        if len(base) != 4 or np.ptp(np.hypot(*(base - base.mean(axis=0)).T)) > 1e-9:
            return None
        sides = base[1:3] - base[:2]
        width, depth = np.hypot(*sides.T).tolist()
        turn = math.atan2(sides[0, 1], sides[0, 0])
    x, y, z = body.centre
    return {
        "width": width, "depth": depth, "height": body.height, "mass": body.mass, "cgHeight": z,
        "cgOffset": math.cos(turn) * x + math.sin(turn) * y, "turn": turn,
        "round": isinstance(body.base, Circle),
    }  # fmt: skip


def _motion(motion: GroundMotion) -> dict[str, Any]:
    """A ground motion of up to three components as a page holds it."""
    each = [
        component
        for component in (motion.x, motion.y, motion.z)
        if component is not None
    ]
    return {
        "name": motion.name,
        "dt": motion.dt,
        "peak_g": peak_of(motion) / GRAVITY,
        "samples": list(map(samples_text, each)),
    }
