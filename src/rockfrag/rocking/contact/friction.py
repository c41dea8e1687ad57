"""Friction of each contact of a body, as tests and the plain reference take it."""

from rockfrag.errors import InputError
from rockfrag.rocking.options import FrictionInput, frictions_of
from rockfrag.system.blocks import SystemLike, as_system
from rockfrag.system.contact import ROUGHEST, Friction

__all__ = ["FrictionInput", "interface_frictions"]


def interface_frictions(
    body: SystemLike, friction: object, name: str = "friction"
) -> tuple[Friction, ...]:
    """Return the friction of each interface of a body, the ground first, one that never slides as rough as can be.

    Raises
    ------
    InputError
        If the numbers do not fit the body, one is negative or none, a static coefficient is less than the kinetic
        one, or none is given.
    """
    found = frictions_of(as_system(body).count, friction, name)
    if all(one is None for one in found):
        raise InputError(f"{name}: no contact has friction; give a coefficient.")
    return tuple(one or Friction(ROUGHEST, ROUGHEST) for one in found)
