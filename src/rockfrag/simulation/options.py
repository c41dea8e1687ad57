"""Options of ``simulate`` and ``overturns`` as people write them, and the system that these make of a body.

In: friction, restitution and starts, in all forms that people use. Out: a system with them. Theory:
``docs/contact.md``, ``docs/restitution.md``.
"""

import math
import numbers
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from rockfrag.base.errors import InputError
from rockfrag.base.input_checks import real_array, real_number, shown
from rockfrag.laws import law_named, law_names, ratio
from rockfrag.system import geometry
from rockfrag.system.blocks import SystemLike, as_system
from rockfrag.system.contact import BY_MOMENTUM, Friction, ImpactLaw, checked_friction
from rockfrag.system.system import Start, System, each_contact

FrictionInput = float | Friction | dict[str, Any] | Sequence[Any]
"""A coefficient for all contacts; a :class:`Friction`; ``{"ground": …, "interface": …}``; of a lone block a pair
(static, kinetic); of several bodies one entry per contact from below."""

StartInput = float | Sequence[float] | None
"""Rotation or angular velocity of each body at the start, from below; one number for a lone block."""

Measured = float | Sequence[float] | None
"""Ratio of the rates after and before an impact of one interface, or the two ratios of impacts that end on the
right and on the left corner; None where momentum is conserved."""


@dataclass(frozen=True)
class MeasuredRestitution:
    """Restitution that was measured, and the law by which a stack follows it (``docs/restitution.md``).

    The measured number is the ratio of the angular velocities after and before an impact of the lone block on a
    support that does not move; all laws give that.  In a stack, where the support gives way, they differ.

    Attributes
    ----------
    value : of a lone block one ratio [-], or (right, left)
        Of impacts that end on its right and on its left corner.  Of a stack a pair (ground, interface), each
        likewise, or None where momentum is conserved.
    law : name of a law in ``rockfrag.laws``
        ``"position"``: the impulse acts nearer the middle of the base where momentum would leave less, and a
        couple brakes where it would leave more; ``"couple"``: a couple brakes or drives the contact, so that its
        relative velocity is a fixed multiple of what momentum leaves; ``"ratio"``: the relative velocities after
        and before have the measured ratio.
    """

    value: float | Sequence[Measured] | dict[str, Any]
    law: str = "position"

    def __post_init__(self) -> None:
        """Refuse a law that does not exist."""
        if self.law not in law_names():
            raise InputError(
                f"restitution: the law {shown(self.law)} is none of {', '.join(law_names())}."
            )


Restitution = float | Sequence[Measured] | dict[str, Any] | MeasuredRestitution | None
"""A measured restitution; numbers alone follow the law ``"position"``, and None conserves momentum."""


NEVER_SLIDES = Friction(20.0, 20.0)
"""Friction of held bodies on each other that nobody said may slide, as of a body in space without any [-]."""


def system_of(
    body: SystemLike,
    friction: FrictionInput | None = None,
    restitution: Restitution = None,
    *,
    theta0: StartInput = None,
    omega0: StartInput = None,
    name: str = "",
) -> System:
    """System of a body with its options.

    Parameters
    ----------
    body, friction, restitution, theta0, omega0 : as of :func:`rockfrag.simulation.simulate`
    name : addition to the name of an option in messages, such as ``[3]``

    Returns
    -------
    The :class:`rockfrag.system.system.System`.
    """
    system = as_system(body)
    contacts, start = list(system.contacts), system.start
    if friction is not None:
        given = _frictions_of(system.count, friction, "friction" + name)
        contacts = [
            replace(contact, friction=mu)
            for contact, mu in zip(contacts, given, strict=True)
        ]
    if restitution is not None:
        laws = _impact_laws(system, restitution, "restitution" + name)
        contacts = [
            replace(contact, law=law)
            for contact, law in zip(contacts, laws, strict=True)
        ]
    if theta0 is not None or omega0 is not None:
        start = Start(
            _start(system, theta0, "theta0"), _start(system, omega0, "omega0")
        )
    if any(given is not None for given in (friction, restitution, theta0, omega0)):
        system = replace(system, contacts=tuple(contacts), start=start)
    return _rough_where_held(system)


def _rough_where_held(system: System) -> System:
    """Let contacts that never slide have a coefficient of 20 instead, where bodies on each other are held.

    What holds them may make a contact slip in an impact. If another one above it may not slide at all, neither can
    move any more, and the bodies jam.
    """
    on_each_other = system.count > 1 or system.support is not None
    if not (system.planar and system.holding and on_each_other):
        return system
    contacts = (
        contact if contact.friction else replace(contact, friction=NEVER_SLIDES)
        for contact in system.contacts
    )
    return replace(system, contacts=tuple(contacts))


def _start(system: System, value: object, name: str) -> tuple[float, ...]:
    """Return rotations [rad] or angular velocities [rad/s] at the start, one for each body; zeros for None."""
    if value is None:
        return (0.0,) * system.count
    values = np.atleast_1d(real_array(name, value))
    if values.shape != (system.count,) or not np.isfinite(values).all():
        raise InputError(
            f"{name}: expected {system.count} finite number(s), got {shown(value)}."
        )
    if name == "theta0" and (np.abs(values) >= math.pi / 2).any():
        raise InputError(
            "theta0: a block turned by π/2 or more lies on its side already."
        )
    return tuple(values.tolist())


def systems_of(
    bodies: Sequence[SystemLike], options: Mapping[str, Any]
) -> tuple[System, ...]:
    """Return the systems that bodies are with their options.

    Parameters
    ----------
    bodies : as a user gives them
    options : those of :func:`rockfrag.simulation.overturns`: friction, restitution, start
    """
    count = len(bodies)
    friction = _friction_of_each(options.get("friction"), count)
    restitution = _one_per_body("restitution", options.get("restitution"), count)
    theta0 = _one_per_body("theta0", options.get("theta0"), count)
    omega0 = _one_per_body("omega0", options.get("omega0"), count)
    names = [f"[{i}]" if count > 1 else "" for i in range(count)]
    each = zip(bodies, friction, restitution, theta0, omega0, names, strict=True)
    return tuple(
        system_of(body, mu, e, theta0=angle, omega0=velocity, name=name)
        for body, mu, e, angle, velocity, name in each
    )


def _one_per_body(name: str, given: Any, count: int) -> list[Any]:
    """Return what is given per body, a list with an entry for each, or nothing for any."""
    if given is None:
        return [None] * count
    if not isinstance(given, (list, tuple, np.ndarray)):
        raise InputError(
            f"{name}: expected a list with one entry per body, got {shown(given)}."
        )
    if len(given) != count:
        raise InputError(
            f"{name}: expected {count} entries, one per body, got {len(given)}."
        )
    return list(given)


def _friction_of_each(friction: Any, count: int) -> list[Any]:
    """Friction of each body; a tuple that could mean several things is refused."""
    if isinstance(friction, np.ndarray) and friction.ndim == 0:
        friction = friction.item()
    if friction is None or isinstance(friction, (numbers.Real, Friction, dict)):
        return [friction] * count
    bare = isinstance(friction, tuple) and all(
        isinstance(v, numbers.Real) for v in friction
    )
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


def _frictions_of(count: int, friction: object, name: str) -> list[Friction | None]:
    """Return the friction of each contact of a body, the ground's first.

    ``count``: of its contacts; ``name``: of the argument, for messages.
    """
    above = ["interface"] if count == 2 else [f"interface {k}" for k in range(1, count)]
    if isinstance(friction, np.ndarray) and friction.ndim == 0:
        friction = friction.item()
    wanted = (
        "a stack takes (ground, interface), each a coefficient or a pair (static, kinetic)"
        if count == 2
        else f"expected one entry for each of {count} contacts"
    )
    # one value holds for all contacts, of which there is nothing to say
    shared = isinstance(friction, (numbers.Real, Friction))
    given = each_contact(name, friction, count, "" if shared else wanted)
    return [
        checked_friction(f"{name} of the {place}", value)
        for place, value in zip(["ground", *above], given, strict=True)
    ]


def _impact_laws(
    system: System, restitution: Restitution, name: str
) -> tuple[ImpactLaw, ...]:
    """Return the law of the impacts of each contact of a system, the ground's first.

    Parameters
    ----------
    system : of which they are
    restitution : None for momentum; a number, a pair (right, left) or an entry a contact, by the law ``position``;
        or a :class:`MeasuredRestitution`, which names its law
    name : of the restitution, for messages
    """
    law, given = "position", restitution
    if isinstance(restitution, MeasuredRestitution):
        law, given = restitution.law, restitution.value
    if given is None:
        return (BY_MOMENTUM,) * system.count
    wanted = (
        "a pair (ground, interface)"
        if system.count == 2
        else f"{system.count} entries from below"
    )
    wanted = f"a stack takes {wanted}, each of which may be None"
    each = each_contact(name, given, system.count, wanted)
    is_lone = system.count == 1
    places = ["block" if is_lone else "ground"] + ["interface"] * (system.count - 1)
    return tuple(
        _law_of(f"{name} of the {place}", law, value, shape, lone=is_lone)
        for place, value, shape in zip(places, each, system.carried, strict=True)
    )


def _law_of(
    name: str, law: str, value: object, shape: geometry.Shape, *, lone: bool
) -> ImpactLaw:
    """Law of the impacts of a contact by a measured restitution ``value``, one number or a pair (right, left).

    ``shape``: of the body above the contact; ``lone``: whether it stands alone.
    """
    if value is None:
        return BY_MOMENTUM
    both = _ratios(name, value, shape)
    right, left = both
    rule = law_named(law)
    ending_right, ending_left = rule.tell(shape, right, +1), rule.tell(shape, left, -1)
    if any(math.isnan(number) for _, number in (ending_right, ending_left)):
        raise InputError(
            f"{name}: momentum leaves this block nothing to rock on with, so the law {law} has nothing to "
            "multiply; choose the law position or ratio."
        )
    if not lone:
        return ImpactLaw(law, right, left)
    # the measured number is the ratio of the lone body, unless its law makes another one of it
    if ending_right[0] == ratio.NUMBER:
        right = ending_right[1]
    if ending_left[0] == ratio.NUMBER:
        left = ending_left[1]
    return ImpactLaw("ratio", right, left)


def _ratios(name: str, measured: object, shape: geometry.Shape) -> list[float]:
    """Return the ratios of impacts that end on the right and on the left corner."""
    bounds = [geometry.largest_restitution(shape, pivot) for pivot in (+1, -1)]
    if not isinstance(measured, (tuple, list, np.ndarray)):
        both, bounds = [real_number(name, measured)] * 2, [min(bounds)] * 2
    elif len(measured) == 2:
        both = [real_number(name, value) for value in measured]
    else:
        raise InputError(
            f"{name}: expected one ratio, or two of impacts that end on the right and on the left "
            f"corner, got {shown(measured)}."
        )
    for value, largest in zip(both, bounds, strict=True):
        if not 0.0 <= value <= largest:
            raise InputError(
                f"{name}: {value:.6g} would gain energy or is no ratio; give a ratio of angular "
                f"velocities from 0 to at most {largest:.6g}, or None to conserve momentum."
            )
    return both
