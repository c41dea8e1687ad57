"""What a user says about friction, checked: static and kinetic coefficients of each interface."""

import math
import numbers
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rockfrag.engines.planar.records import system_record
from rockfrag.errors import InputError
from rockfrag.input_checks import shown
from rockfrag.system.blocks import Block, Body, as_system
from rockfrag.system.contact import BY_MOMENTUM, ROUGHEST, Friction, ImpactLaw

FrictionInput = float | Sequence[float | tuple[float, float]]
"""A number for a lone block; (ground, interface) for a stack; a pair (static, kinetic) in place of a number."""


def interface_frictions(
    body: Body, friction: object, name: str = "friction"
) -> tuple[Friction, ...]:
    """Return the friction of each interface of a body, the ground first.

    Parameters
    ----------
    body
        A block (one interface) or a stack (two).
    friction
        A lone block takes a coefficient, or a pair (static, kinetic).  A stack takes (ground, interface),
        each a coefficient or a pair; one number alone holds at both.

    Raises
    ------
    InputError
        If the numbers do not fit the body, one is negative or not a number, or a static coefficient is
        less than the kinetic one.
    """
    if isinstance(friction, numbers.Real):
        given: list[object] = [friction] * (1 if isinstance(body, Block) else 2)
    elif isinstance(body, Block):
        given = [friction]
    else:
        if not isinstance(friction, (list, tuple, np.ndarray)) or len(friction) != 2:
            raise InputError(
                f"{name}: a stack takes (ground, interface), each a coefficient or a pair (static, "
                f"kinetic), got {shown(friction)}."
            )
        given = list(friction)
    places = ("ground", "interface")
    return tuple(
        _one(f"{name} of the {place}", value) for place, value in zip(places, given, strict=False)
    )


def listed_frictions(bodies: Sequence[Body], friction: object) -> list[tuple[Friction, ...]]:
    """Return the friction of each interface of each body; one number holds everywhere.

    Raises
    ------
    InputError
        If there is not one entry for each body, or one does not fit its body.
    """
    if isinstance(friction, numbers.Real):
        friction = [friction] * len(bodies)
    if not isinstance(friction, (list, tuple, np.ndarray)) or len(friction) != len(bodies):
        raise InputError(
            f"friction: expected a number or a list with {len(bodies)} entries, one per body, "
            f"got {shown(friction)}."
        )
    return [
        interface_frictions(body, one, f"friction[{i}]")
        for i, (body, one) in enumerate(zip(bodies, friction, strict=True))
    ]


def contact_record(
    body: Body, frictions: Sequence[Friction], g: float, laws: Sequence[ImpactLaw] | None = None
) -> np.void:
    """Return the record of a body, with friction and laws of impacts of its contacts, that kernels read."""
    system = as_system(body)
    contacts = tuple(
        replace(contact, friction=friction, law=law)
        for contact, friction, law in zip(
            system.contacts, frictions, laws or (BY_MOMENTUM,) * system.count, strict=True
        )
    )
    return system_record(replace(system, contacts=contacts), g)


def check_impacts_follow(restitution: object, linear: bool) -> None:
    """Refuse what bodies that slide and fly cannot have.

    Raises
    ------
    InputError
        For a measured restitution or linearised equations.
    """
    if linear:
        raise InputError("linear: with friction only the full equations are solved.")
    if _is_measured(restitution):
        raise InputError(
            "restitution: with friction the impacts follow from Coulomb's law; leave it out."
        )


def _is_measured(restitution: object) -> bool:
    if isinstance(restitution, (list, tuple, np.ndarray)):
        return any(_is_measured(one) for one in restitution)
    return restitution is not None


def _one(name: str, value: object) -> Friction:
    pair = (value, value) if isinstance(value, numbers.Real) else value
    if not isinstance(pair, (list, tuple, np.ndarray)) or len(pair) != 2:
        raise InputError(
            f"{name}: expected a coefficient or a pair (static, kinetic), got {shown(value)}."
        )
    for number in pair:
        known = isinstance(number, numbers.Real) and not isinstance(number, (bool, np.bool_))
        if not known or math.isnan(number) or number < 0:
            raise InputError(f"{name}: a coefficient is 0 or more, got {shown(number)}.")
    static, kinetic = (min(float(number), ROUGHEST) for number in pair)
    if kinetic > static:
        raise InputError(
            f"{name}: the static coefficient {static:g} is less than the kinetic one {kinetic:g}; "
            "give (static, kinetic)."
        )
    return Friction(static, kinetic)
