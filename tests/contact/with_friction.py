"""One body with friction, by the contact kernels alone: what tests hold beside pure rocking and other programs."""

from rockfrag.engines.planar.history import CLOSING, contact_run, response_of
from rockfrag.engines.response import Response
from rockfrag.engines.steps import STEP
from rockfrag.rocking.inputs import MotionLike, ground_motion
from rockfrag.rocking.measured_restitution import Restitution
from rockfrag.rocking.options import FrictionInput, StartInput, system_of
from rockfrag.system.blocks import SystemLike
from rockfrag.units import GRAVITY


def simulate_with_friction(
    body: SystemLike,
    acceleration: MotionLike,
    dt: float,
    *,
    friction: FrictionInput,
    restitution: Restitution = None,
    vertical: MotionLike | None = None,
    theta0: StartInput = None,
    omega0: StartInput = None,
    g: float = GRAVITY,
    step: float = STEP,
    closing: float = CLOSING,
) -> Response:
    """Simulate what :func:`rockfrag.rocking.simulate` does, never by pure rocking.

    Parameters
    ----------
    body, acceleration, dt, friction, restitution, vertical, theta0, omega0, g
        As in :func:`rockfrag.rocking.simulate`.
    step
        Largest product of the frequency parameter and the step [-].
    closing
        Parting speed over √(g b) below which a contact that would fall shut again stays closed after an
        impact [-].

    Raises
    ------
    InputError
        If an argument cannot be used; the message says which and why.
    """
    system = system_of(body, friction, restitution, theta0, omega0)
    motion = ground_motion(acceleration, dt, vertical)
    return response_of(contact_run(system, motion, g, step, closing))
