"""One body with friction, by the contact kernels alone: what tests hold beside pure rocking and other programs."""

from rockfrag.engines.planar.cases import contact_run, response_of
from rockfrag.rocking.inputs import ground_motion
from rockfrag.rocking.options import system_of
from rockfrag.units import GRAVITY


def simulate_with_friction(
    body, acceleration, dt, *, friction, vertical=None, omega0=None, g=GRAVITY
):
    """Simulate what :func:`rockfrag.rocking.simulate` does, never by pure rocking."""
    system = system_of(body, friction, omega0=omega0)
    return response_of(contact_run(system, ground_motion(acceleration, dt, vertical), g))
