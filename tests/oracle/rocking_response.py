"""What the reference integrator returns."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray


@dataclass(frozen=True)
class ReferenceContactEvent:
    """One change of the contact state.

    ``kind`` is "opening", "impact", "closing" (an impact too weak to part again) or "overturning";
    angular velocities in [rad/s], columns as in the response.
    """

    time: float
    kind: str
    before: tuple[int, ...]
    after: tuple[int, ...]
    theta: tuple[float, ...]
    omega_before: tuple[float, ...]
    omega_after: tuple[float, ...]


@dataclass(frozen=True)
class ReferenceResponse:
    """Response at the samples of the motion and, if it goes on, every dt after its end.

    Parameters
    ----------
    time
        Time [s], shape (n,); the last sample before overturning is the last one.
    theta, omega
        Rotation [rad] and angular velocity [rad/s], shape (n, 1) or (n, 2): pedestal, statue.
    state
        Contact states, shape (n, 1) or (n, 2): ground, interface.
    contact_events
        Every contact event in order.
    overturned
        Whether a block passed π/2.
    overturned_body
        0 for none, 1 for the lone block or the pedestal, 2 for the statue.
    overturning_time
        When it passed π/2 [s]; NaN if none did.
    at_rest
        Whether everything stands in full contact at the end.
    given_way
        Impacts in which a measured restitution gave way, lest energy grow.
    """

    time: NDArray[np.float64]
    theta: NDArray[np.float64]
    omega: NDArray[np.float64]
    state: NDArray[np.int8]
    contact_events: tuple[ReferenceContactEvent, ...]
    overturned: bool
    overturned_body: int
    overturning_time: float
    at_rest: bool
    given_way: int
