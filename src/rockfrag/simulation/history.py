"""One body, one motion, everything about the response.

In: a body, a motion [m/s²], options. Out: a :class:`rockfrag.outcomes.Response`. Theory: ``docs/rocking.md``,
``docs/contact.md``.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

from rockfrag.base.input_checks import positive_number
from rockfrag.base.keywords import named_keywords
from rockfrag.base.units import GRAVITY
from rockfrag.engines.contract import Case, Cases, Request, engine_for
from rockfrag.outcomes.response import Response
from rockfrag.simulation.ensemble import LightBodies
from rockfrag.simulation.inputs import (
    MotionLike,
    checked_switch,
    ground_motion,
    warn_of_units,
)
from rockfrag.simulation.options import (
    FrictionInput,
    Restitution,
    StartInput,
    system_of,
)
from rockfrag.system.blocks import SystemLike


@named_keywords
def simulate(
    body: SystemLike,
    motion: MotionLike,
    dt: float | None = None,
    *,
    theta0: StartInput = None,
    omega0: StartInput = None,
    restitution: Restitution = None,
    linear: bool = False,
    friction: FrictionInput | None = None,
    vertical: MotionLike | None = None,
    g: float = GRAVITY,
) -> Response:
    """Simulate a block, a stack or a column under the motion of the ground.

    Without ``friction`` bodies rock and never slide; with it they stick, slide, rock, do both, fly and land
    (``docs/contact.md``).

    Parameters
    ----------
    body : a :class:`Block`, a :class:`Stack`, a :class:`Column` or a :class:`System`
    motion
        A :class:`Motion`, a :class:`GroundMotion`, or the acceleration of the ground or floor [m/s²], shape (n,),
        linear between samples, n ≥ 2.
    dt : sampling interval of an acceleration [s]; a Motion has its own
    theta0, omega0
        Rotations [rad] and angular velocities [rad/s] at the start: a number, or one for each body from below.
    restitution
        Measured ratio of angular velocities of an impact: a number, or for several bodies
        ``{"ground": …, "interface": …}`` or (ground, interface), or a :class:`MeasuredRestitution` with its law;
        None, the default, conserves momentum (Housner, 1963; Spanos, Roussis and Politis, 2001).
    linear : use the linearised equations of motion (Housner, 1963; Psycharis, 1990)
    friction
        Coefficient of friction of all contacts, or ``{"ground": …, "interface": …}``, or (ground, interface) of a
        stack; ``Friction(static, kinetic)`` or a pair may stand in place of each number, and numbers may be
        infinite.  None: nothing slides and nothing jumps.
    vertical : vertical acceleration of the ground or floor, upwards [m/s²], sampled as ``motion``
    g : acceleration of gravity [m/s²]

    Returns
    -------
    Response
        Histories, contact events, energies and forces; of a body in space under both components a
        :class:`rockfrag.engines.spatial.SpatialResponse`.

    Warns
    -----
    LightBodies
        If pure rocking needed a contact to pull, so that a real body would have left the ground.
    UserWarning
        If a number looks as if it were given in another unit.

    Examples
    --------
    A statue under one second of a sine of 4 m/s²:

    >>> from rockfrag import Block, simulate
    >>> from rockfrag.motions import one_sine
    >>> response = simulate(Block(width=0.3, height=1.2, mass=180.0), one_sine(4.0, period=1.0))
    >>> response.overturned, response.overturned_body
    (True, 'block')
    >>> response.theta.shape == (response.time.size, 1)
    True
    """
    shaking = ground_motion(motion, dt, vertical)
    positive_number("g", g, "m/s²")
    system = system_of(body, friction, restitution, theta0=theta0, omega0=omega0)
    request = Request(history=True, linear=checked_switch("linear", linear), g=g)
    engine = engine_for(system, shaking, request)
    response: Response = engine.history(Case(system, shaking, 1.0, request))
    warn_of_units(
        Cases((system,), (shaking,), np.ones((1, 1)), request), motion, stacklevel=4
    )
    if not math.isnan(response.lost_contact):
        warnings.warn(
            f"at {response.lost_contact:.3f} s the body would have left the ground, on which pure rocking holds "
            "it; what follows is no answer. Give friction= to let it fly.",
            LightBodies,
            stacklevel=3,
        )
    return response
