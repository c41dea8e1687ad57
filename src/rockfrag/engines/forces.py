"""Contact forces and positions of a computed response: was the model allowed to be used?

The forces follow from the absolute accelerations of the centres of gravity: N2 = m2 (g + y2''),
T2 = m2 x2'', and the sums over both blocks at the ground.
"""

import numpy as np
from numpy.typing import NDArray

from rockfrag.arrays import Floats
from rockfrag.elementary import hypot
from rockfrag.engines.kernels.jit import compiling_alone
from rockfrag.engines.kernels.record import fill_sines
from rockfrag.system import geometry
from rockfrag.system.system import System


class Turned:
    """The links of one or two bodies that rock, from pivot to pivot and to the centres, turned as they are."""

    def __init__(self, system: System, state: NDArray[np.int64], theta: Floats) -> None:
        self.system, side = system, (state < 0).astype(np.int64)
        self.sine, self.cosine = np.empty_like(theta), np.empty_like(theta)
        with compiling_alone(fill_sines):
            # the same on every processor
            fill_sines(theta, self.sine, self.cosine)
        ways = (+1, -1)
        # arms of each sample, (n, 2), and the body that each turns with
        arm = np.array([geometry.arm(system.shapes[0], way) for way in ways])[side[:, 0]]
        self.links = [(arm, 0)]
        if system.count == 2:
            feet = np.array([[geometry.reach(system.pile, a, b) for b in ways] for a in ways])
            above = np.array([geometry.upper_arm(system.pile, way) for way in ways])
            self.links += [(feet[side[:, 0], side[:, 1]], 0), (above[side[:, 1]], 1)]

    def link(self, number: int) -> tuple[Floats, Floats]:
        """X and y of a link [m]: to the lower centre, to the foot of the upper body, from there to its centre."""
        arm, body = self.links[number]
        (ax, ay), s, c = arm.T, self.sine[:, body], self.cosine[:, body]
        return ax * c + ay * s, -ax * s + ay * c

    def centres(self) -> Floats:
        """Centres of gravity relative to the ground [m], shape (n, blocks, 2)."""
        found = [self.link(0)]
        if self.system.count == 2:
            (xd, yd), (x, y) = self.link(1), self.link(2)
            found.append((xd + x, yd + y))
        made = np.stack([np.column_stack(each) for each in found], axis=1)
        made[..., 0] += self.system.shapes[0].x - self.links[0][0][:, :1]
        return made

    def forces(
        self, ground: Floats, gravity: Floats, omega: Floats, alpha: Floats
    ) -> tuple[Floats, Floats]:
        """Normal and friction force of each interface, across and along the face that carries [N], (n, blocks)."""

        def acceleration(number: int) -> tuple[Floats, Floats]:
            """Acceleration of the tip of a link that turns clockwise about its foot [m/s²]."""
            (x, y), body = self.link(number), self.links[number][1]
            w, q = omega[:, body], alpha[:, body]
            return q * y - w * w * x, -q * x - w * w * y

        mass, (x1, y1) = self.system.shapes[0].mass, acceleration(0)
        friction, normal = mass * (ground + x1), mass * (gravity + y1)
        if self.system.count == 1:
            return normal[:, np.newaxis], friction[:, np.newaxis]
        pile, (xd, yd), (x2, y2) = self.system.pile, acceleration(1), acceleration(2)
        level = pile.upper.mass * (ground + xd + x2)
        upright = pile.upper.mass * (gravity + yd + y2)
        # of the interface so far upright and level: the pedestal's top turns with it
        x, y = pile.right[0] - pile.left[0], pile.right[1] - pile.left[1]
        length, sine, cosine = hypot(x, y), self.sine[:, 0], self.cosine[:, 0]
        tx, ty = (x * cosine + y * sine) / length, (y * cosine - x * sine) / length
        return (
            np.column_stack([normal + upright, tx * upright - ty * level]),
            np.column_stack([friction + level, tx * level + ty * upright]),
        )
