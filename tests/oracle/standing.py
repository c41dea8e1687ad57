"""How planar bodies stand on each other, from the definitions of a system alone."""

import math
from typing import NamedTuple

import numpy as np

from rockfrag.system import System, geometry
from rockfrag.system.blocks import Block, Stack


class StandingBody(NamedTuple):
    """One body as it stands."""

    mass: float
    inertia: float  # about the centre
    centre: np.ndarray  # of gravity in the ground's frame, shape (2,)
    # left and right end of its contact from its centre, shape (2, 2)
    corners: np.ndarray
    edges: np.ndarray  # of its face, likewise
    base: float  # angle of the base, clockwise
    face: float  # of the face


def turn(angle: float) -> np.ndarray:
    """Matrix of a clockwise rotation."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, s], [-s, c]])


def upper_on_contact(stack: Stack) -> Block:
    """Return the statue as it stands on the contact: itself, or one whose base is no wider than the overlap."""
    pile = stack.pile
    if pile.upper is pile.above:
        return stack.upper
    aside = (pile.low + pile.high) / 2 - stack.offset
    standing = stack.upper.shape
    x, y = geometry.turned(standing.x - aside, standing.y, -stack.upper.lean)
    made = Block(
        *(pile.high - pile.low, stack.upper.height, stack.upper.mass),
        *(stack.upper.centroidal_inertia, y, x, stack.upper.lean),
    )
    # to the last bit what the kernels know, without the turn there and back
    vars(made)["shape"] = pile.upper
    return made


def standing(system: System) -> list[StandingBody]:
    """Return the bodies from below."""
    found: list[StandingBody] = []
    origin, angle = np.zeros(2), 0.0  # of the face below
    low, high = -math.inf, math.inf  # its ends
    for body, contact in zip(system.in_plane().bodies, system.contacts, strict=True):
        own = origin + turn(angle) @ [contact.offset[0] if found else 0.0, 0.0]
        middle = np.array([(body.base.left + body.base.right) / 2, 0.0])
        tilted = turn(contact.tilt) @ (
            np.array([body.centre[0], body.centre[2]]) - middle
        )
        centre = own + turn(angle) @ (middle + tilted)
        shift = contact.offset[0] if found else 0.0
        ends = max(body.base.left, low - shift), min(body.base.right, high - shift)
        corners = np.array([own + turn(angle) @ [x, 0.0] for x in ends]) - centre
        face = angle + contact.tilt
        outline = body.face or body.base
        edges = [
            own
            + turn(angle) @ (middle + turn(contact.tilt) @ ([x, body.height] - middle))
            for x in (outline.left, outline.right)
        ]
        found.append(
            StandingBody(
                body.mass,
                body.inertia,
                centre,
                corners,
                np.array(edges) - centre,
                angle,
                face,
            )
        )
        raised = turn(contact.tilt) @ ([0.0, body.height] - middle)
        origin, angle = own + turn(angle) @ (middle + raised), face
        low, high = outline.left, outline.right
    return found
