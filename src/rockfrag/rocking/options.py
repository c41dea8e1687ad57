"""Options of every door as people write them, and the system that they make of a body."""

import numbers
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from rockfrag.errors import InputError
from rockfrag.input_checks import shown
from rockfrag.rocking.inputs import checked_start
from rockfrag.rocking.measured_restitution import Restitution, impact_laws
from rockfrag.system.blocks import SystemLike, as_system
from rockfrag.system.contact import Friction, checked_friction
from rockfrag.system.system import Start, System, each_contact

FrictionInput = float | Friction | dict[str, Any] | Sequence[Any]
"""A coefficient for all contacts; a :class:`Friction`; ``{"ground": …, "interface": …}``; of a lone block a pair
(static, kinetic); of several bodies one entry per contact from below."""

StartInput = float | Sequence[float] | None
"""Rotation or angular velocity of each body at the start, from below; one number for a lone block."""


def system_of(
    body: SystemLike,
    friction: FrictionInput | None = None,
    restitution: Restitution = None,
    theta0: StartInput = None,
    omega0: StartInput = None,
    name: str = "",
) -> System:
    """Return the system that a body and its options, as of :func:`rockfrag.rocking.simulate`, are.

    ``name`` is what messages add to the name of an option, such as ``[3]``.
    """
    system = as_system(body)
    contacts = list(system.contacts)
    if friction is not None:
        given = frictions_of(system.count, friction, "friction" + name)
        contacts = [
            replace(contact, friction=mu) for contact, mu in zip(contacts, given, strict=True)
        ]
    if restitution is not None:
        laws = impact_laws(system, restitution, "restitution" + name)
        contacts = [replace(contact, law=law) for contact, law in zip(contacts, laws, strict=True)]
    start = system.start
    if theta0 is not None or omega0 is not None:
        start = Start(
            checked_start(system, theta0, "theta0"), checked_start(system, omega0, "omega0")
        )
    if friction is None and restitution is None and start is system.start:
        return system
    return replace(system, contacts=tuple(contacts), start=start)


def systems_of(bodies: Sequence[SystemLike], options: Mapping[str, Any]) -> tuple[System, ...]:
    """Return the systems that bodies and their options, as of :func:`rockfrag.rocking.overturns`, are."""
    count = len(bodies)
    friction = _friction_of_each(options.get("friction"), count)
    restitution, theta0, omega0 = (
        _one_per_body(name, options.get(name), count)
        for name in ("restitution", "theta0", "omega0")
    )
    names = [f"[{i}]" if count > 1 else "" for i in range(count)]
    return tuple(map(system_of, bodies, friction, restitution, theta0, omega0, names))


def _one_per_body(name: str, given: Any, count: int) -> list[Any]:
    """Return what is given per body, a list with an entry for each, or nothing for any."""
    if given is None:
        return [None] * count
    if not isinstance(given, (list, tuple, np.ndarray)):
        raise InputError(f"{name}: expected a list with one entry per body, got {shown(given)}.")
    if len(given) != count:
        raise InputError(f"{name}: expected {count} entries, one per body, got {len(given)}.")
    return list(given)


def _friction_of_each(friction: Any, count: int) -> list[Any]:
    """Friction of each body; a tuple that could mean several things is refused."""
    if isinstance(friction, np.ndarray) and friction.ndim == 0:
        friction = friction.item()
    if friction is None or isinstance(friction, (numbers.Real, Friction, dict)):
        return [friction] * count
    bare = isinstance(friction, tuple) and all(isinstance(v, numbers.Real) for v in friction)
    if bare:
        raise InputError(
            f"friction: {shown(friction)} could be one coefficient per body, (ground, interface) or (static, "
            "kinetic); give a list with one entry per body, or name the contacts: "
            '{"ground": 0.6, "interface": 0.2}.'
        )
    if not isinstance(friction, (list, tuple, np.ndarray)) or len(friction) != count:
        raise InputError(
            f"friction: expected a number or a list with {count} entries, one per body, got {shown(friction)}."
        )
    return list(friction)


def frictions_of(count: int, friction: object, name: str = "friction") -> list[Friction | None]:
    """Return the friction of each contact of a body, the ground's first."""
    above = ["interface"] if count == 2 else [f"interface {k}" for k in range(1, count)]
    places = ["ground", *above]
    if isinstance(friction, np.ndarray) and friction.ndim == 0:
        friction = friction.item()
    wanted = (
        "a stack takes (ground, interface), each a coefficient or a pair (static, kinetic)"
        if count == 2
        else f"expected one entry for each of {count} contacts"
    )
    shared = isinstance(friction, (numbers.Real, Friction))
    given = each_contact(name, friction, count, "" if shared else wanted)
    return [
        checked_friction(f"{name} of the {place}", value)
        for place, value in zip(places, given, strict=True)
    ]
