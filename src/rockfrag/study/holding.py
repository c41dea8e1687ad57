"""What holds the bodies of an arrangement, as a study's tables write it (``docs/holding.md``).

In: columns of ``arrangements.csv`` beside what stands on what, and a table of isolators.  Out: systems with walls,
ties, bonds and isolators.
"""

import math
import os
from collections.abc import Mapping
from typing import Any

from rockfrag.base.errors import InputError, errors_of
from rockfrag.base.tabular import Row, read_rows
from rockfrag.system import mounts
from rockfrag.system.constraints import Constraint, Wall
from rockfrag.system.contact import Friction
from rockfrag.system.support import (
    YIELDS_AT,
    BilinearIsolator,
    SlidingPendulum,
    Support,
)
from rockfrag.system.system import System, hold

LENGTHS = (
    *("wall_m", "wall_left_m", "wall_height_m", "putty_spread_m"),
    *("cord_slack_m", "bracket_slack_m"),
)
FORCES = ("putty_n", "putty_shear_n", "cord_n", "bracket_n")
QUANTITIES = (*LENGTHS, *FORCES)
"""Columns of lengths and forces, whose unit may stand in the name."""
COLUMNS = (
    *QUANTITIES,
    *("wall_friction", "wall_restitution", "cord_n_m", "bracket_n_m", "casters"),
)
"""Columns of an arrangement that say what holds it."""
TOUCHES = 1e-9  # gap of a wall that is none, but for rounding [m]
_WALL = (("wall_m", "wall_left_m"), "is of a wall", "its distance")
_PUTTY = (("putty_n",), "is of putty", "its tensile capacity")
_CORD = (("cord_n_m",), "is of cords", "their stiffness")
_BRACKET = (("bracket_n_m",), "is of a bracket", "its stiffness")
_PARTS = {
    **dict.fromkeys(("wall_height_m", "wall_friction", "wall_restitution"), _WALL),
    **dict.fromkeys(("putty_shear_n", "putty_spread_m"), _PUTTY),
    **dict.fromkeys(("cord_slack_m", "cord_n"), _CORD),
    **dict.fromkeys(("bracket_slack_m", "bracket_n"), _BRACKET),
}
"""Columns that hold nothing alone: of which others one must be stated too, of what they are, what those state."""
_ISOLATOR_LENGTHS = ("radius_m", "stroke_m", "yield_m")
_ISOLATOR = (
    *_ISOLATOR_LENGTHS,
    *("friction", "restitution", "stiffness_n_m", "strength_n"),
)


def read_isolators(path: str | os.PathLike[str]) -> dict[str, Support]:
    """Read a table of isolators.

    Parameters
    ----------
    path : CSV file with ``name``, ``mass_kg`` of the plate, ``stroke_m`` to its stop and ``restitution`` there;
        of a sliding pendulum ``radius_m`` (empty: flat) and ``friction``, of a bilinear one ``stiffness_n_m``
        after yielding, ``strength_n`` and ``yield_m``

    Returns
    -------
    The isolators by name.
    """
    found: dict[str, Support] = {}
    quantities = ("mass_kg", *_ISOLATOR_LENGTHS)
    for row in read_rows(path, ["name", "mass_kg"], _ISOLATOR, quantities=quantities):
        name = row.text("name")
        if name in found:
            raise row.error("name", f"{name} is given twice")
        stated = {"mass_kg": row.quantity("mass_kg", above=0)}
        for column in _ISOLATOR:
            if row.has(column):
                is_length = column in _ISOLATOR_LENGTHS
                stated[column] = (row.quantity if is_length else row.number)(column)
        with errors_of(f"{row.path}, line {row.line}"):
            found[name] = isolator_of(stated)
    return found


def isolator_of(stated: Mapping[str, float]) -> Support:
    """Isolator of what is stated of it.

    Parameters
    ----------
    stated : values in SI units by the names of the columns of :func:`read_isolators`

    Returns
    -------
    A bilinear one where its stiffness is stated, a sliding pendulum otherwise.
    """
    about = {
        "mass": stated["mass_kg"],
        "stroke": stated.get("stroke_m", math.inf),
        "restitution": stated.get("restitution", 0.0),
    }
    if "stiffness_n_m" in stated:
        for name in ("radius_m", "friction"):
            if name in stated:
                raise InputError(f"{name}: a bilinear isolator has none; leave it out.")
        return BilinearIsolator(
            **about,
            stiffness=stated["stiffness_n_m"],
            strength=stated.get("strength_n", 0.0),
            yield_displacement=stated.get("yield_m", YIELDS_AT),
        )
    for name in ("strength_n", "yield_m"):
        if name in stated:
            raise InputError(
                f"{name}: is of a bilinear isolator; give its stiffness_n_m too."
            )
    mu = stated.get("friction", 0.0)
    return SlidingPendulum(
        **about,
        radius=stated.get("radius_m", math.inf),
        friction=Friction(mu, mu) if mu else None,
    )


def read_holders(row: Row) -> dict[str, float | str]:
    """Read the columns of ``arrangements.csv`` that state what holds an arrangement.

    Parameters
    ----------
    row : of the arrangement

    Returns
    -------
    Values in SI units by the names of :data:`COLUMNS`, of those that are not empty.
    """
    stated: dict[str, float | str] = {}
    for column in COLUMNS:
        if not row.has(column):
            continue
        if column == "casters":
            stated[column] = row.text(column)
        elif column in QUANTITIES:
            stated[column] = row.quantity(column)
        else:
            stated[column] = row.number(column)
    if (alone := stated_alone(stated)) is not None:
        raise row.error(*alone)
    return stated


def stated_alone(stated: Mapping[str, Any]) -> tuple[str, str] | None:
    """Find what is stated of a holder that is not there, such as the strength of a bracket without its stiffness.

    Parameters
    ----------
    stated : values by the names of :data:`COLUMNS`

    Returns
    -------
    The first such column, and what is wrong with it; None if there is none.
    """
    for column, (needed, of, what) in _PARTS.items():
        if column in stated and not any(name in stated for name in needed):
            return column, f"{of}; give {' or '.join(needed)}, {what}, too"
    return None


def held_as_stated(
    system: System, stated: Mapping[str, Any], support: Support | None = None
) -> System:
    """System with what is stated that holds it.

    Parameters
    ----------
    system, stated : what stands there, and values in SI units by the names of :data:`COLUMNS`; under
        ``isolator`` perhaps what :func:`isolator_of` takes
    support : isolator under it; None: that which is stated, or the ground

    Returns
    -------
    The system with its walls, ties, bonds and isolator.

    Raises
    ------
    InputError
        If something is stated of a holder that is not there.
    """
    if (alone := stated_alone(stated)) is not None:
        raise InputError("{}: {}.".format(*alone))
    constraints: list[Constraint] = [
        _wall(system, stated, column, side)
        for column, side in (("wall_m", 1), ("wall_left_m", -1))
        if column in stated
    ]
    if "cord_n_m" in stated:
        constraints += mounts.cords_at_top(system, *_springs(stated, "cord"))
    if "bracket_n_m" in stated:
        gap, springs = stated.get("wall_m", 0.0), _springs(stated, "bracket")
        constraints.append(mounts.bracket_at_top(system, *springs, length=gap))
    if "casters" in stated:
        system = mounts.on_casters(system, stated["casters"])
    bond = None
    if "putty_n" in stated:
        bond = mounts.putty_under(
            system,
            stated["putty_n"],
            stated.get("putty_shear_n"),
            stated.get("putty_spread_m"),
        )
    if "isolator" in stated:
        support = isolator_of(stated["isolator"])
    return hold(system, *constraints, bonds=bond, support=support)


def held_by(system: System) -> str:
    """What holds an arrangement, in words.

    Parameters
    ----------
    system : of a study

    Returns
    -------
    Such as ``wall 1, bond 2``, by the names in tables of what each had to bear; empty if it stands free.
    """
    named = {"support": "isolator"}
    words = [named.get(name, name) for name in system.holding]
    if _rolls(system):
        words.append("casters that roll")
    return ", ".join(words)


def rocks_like_free(system: System) -> bool:
    """Whether a planar arrangement starts to rock where it would if nothing held it.

    A tie bears nothing before what it holds has moved, and a wall that is off nothing before it is hit.

    Parameters
    ----------
    system : at rest

    Returns
    -------
    False with a bond, an isolator, a wall that touches, or casters that roll.
    """
    if system.bonds or system.support is not None or _rolls(system):
        return False
    walls = [each for each in system.constraints if isinstance(each, Wall)]
    return all(
        wall.distance > mounts.reach(system, wall.side) + TOUCHES for wall in walls
    )


def _rolls(system: System) -> bool:
    """Whether an arrangement stands on free casters."""
    return system.contacts[0].friction == mounts.ROLLING


def _wall(system: System, stated: Mapping[str, Any], column: str, side: int) -> Wall:
    """Return the wall that a column names, on the right (+1) or the left side."""
    mu = stated.get("wall_friction", 0.0)
    return mounts.wall_beside(
        system,
        stated[column],
        side,
        height=stated.get("wall_height_m", math.inf),
        friction=Friction(mu, mu) if mu else None,
        restitution=stated.get("wall_restitution", 0.0),
    )


def _springs(stated: Mapping[str, Any], name: str) -> tuple[float, float, float]:
    """Return stiffness [N/m], slack [m] and strength [N] of cords or a bracket."""
    slack, strength = stated.get(f"{name}_slack_m", 0.0), stated.get(f"{name}_n")
    return stated[f"{name}_n_m"], slack, math.inf if strength is None else strength
