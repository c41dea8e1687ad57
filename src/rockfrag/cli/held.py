"""Options of ``rockfrag simulate`` that say what holds a body, and the lines on what they had to bear.

In: options as they are typed.  Out: a system with walls, ties, bonds and an isolator (``docs/holding.md``).
"""

import argparse
import math
from typing import TYPE_CHECKING, Any

from rockfrag.base.errors import InputError

if TYPE_CHECKING:
    from rockfrag.system.system import System

OPTIONS = ("wall", "kerb", "putty", "cord", "bracket", "pendulum", "casters")


def add_holding_options(command: argparse.ArgumentParser) -> None:
    """Add the options that say what holds a body.

    Parameters
    ----------
    command : parser of the command
    """
    numbers: dict[str, Any] = {"nargs": "+", "type": float}
    command.add_argument(
        "--wall", **numbers, metavar="M",
        help="gap to a wall on the right, and perhaps to one on the left [m]",
    )  # fmt: skip
    command.add_argument(
        "--kerb", nargs=2, type=float, metavar="M",
        help="gap to a kerb on the right, and its height [m]",
    )  # fmt: skip
    command.add_argument(
        "--putty", **numbers, metavar="N",
        help="tensile capacity of putty under the uppermost body [N], perhaps its capacity in shear [N] and half "
        "the distance of its pads [m]",
    )  # fmt: skip
    for name, words in (
        ("cord", "two cords from its top to both sides"),
        ("bracket", "a bracket from its top to a wall"),
    ):
        command.add_argument(
            f"--{name}", **numbers, metavar="K",
            help=f"stiffness of {words} [N/m], perhaps slack [m] and strength [N]",
        )  # fmt: skip
    command.add_argument(
        "--pendulum", **numbers, metavar="R",
        help="isolator under it: radius of its dish [m], friction, perhaps stroke to its stop [m] and mass of its "
        "plate [kg]",
    )  # fmt: skip
    command.add_argument(
        "--casters", choices=("locked", "free"), help="casters under the lowest body"
    )


def is_held(options: argparse.Namespace) -> bool:
    """Whether an option says that something holds the body."""
    return any(getattr(options, name) is not None for name in OPTIONS)


def held(options: argparse.Namespace, system: "System") -> "System":
    """System with what the options say that holds it.

    Parameters
    ----------
    options, system : as typed, and what stands there, its friction among it

    Returns
    -------
    The system.
    """
    from rockfrag.system import SlidingPendulum, hold, mounts
    from rockfrag.system.contact import checked_friction

    constraints: list[Any] = []
    for gap, side in zip(_some(options, "wall", 1, 2), (1, -1), strict=False):
        constraints.append(mounts.wall_beside(system, gap, side))
    if options.kerb is not None:
        gap, height = options.kerb
        constraints.append(mounts.wall_beside(system, gap, height=height))
    if options.cord is not None:
        constraints += mounts.cords_at_top(system, *_some(options, "cord", 1, 3))
    if options.bracket is not None:
        springs = _some(options, "bracket", 1, 3)
        constraints.append(mounts.bracket_at_top(system, *springs))
    putty = _some(options, "putty", 1, 3)
    bond = mounts.putty_under(system, *putty) if putty else None
    support = None
    if options.pendulum is not None:
        radius, mu, *more = _some(options, "pendulum", 2, 4)
        stroke, mass = (*more, *(math.inf, 0.1 * system.mass)[len(more) :])
        support = SlidingPendulum(
            mass=mass,
            radius=radius,
            friction=checked_friction("--pendulum", mu),
            stroke=stroke,
        )
    if options.casters is not None:
        system = mounts.on_casters(system, options.casters)
    return hold(system, *constraints, bonds=bond, support=support)


def _some(options: argparse.Namespace, name: str, least: int, most: int) -> list[float]:
    """Return the numbers of an option; none if it was not given."""
    given: list[float] = getattr(options, name) or []
    if given and not least <= len(given) <= most:
        raise InputError(
            f"--{name}: expected {least} to {most} numbers, got {len(given)}."
        )
    return given


def lines_on_holding(response: Any) -> list[str]:
    """Lines on what each wall, tie, bond and isolator had to bear.

    Parameters
    ----------
    response : a :class:`rockfrag.outcomes.response.Response`

    Returns
    -------
    The lines.
    """
    lines = []
    table = response.constraints
    for row in () if table is None else table.to_dict("records"):
        parts = [f"largest force {row['largest_force_n']:.0f} N"]
        if row["hits"]:
            parts.append(
                f"{row['hits']} hits, the hardest {row['largest_impulse_n_s']:.1f} N s"
            )
        if not math.isnan(row["breaking_time_s"]):
            parts.append(f"broke at {row['breaking_time_s']:.3f} s")
        if not math.isnan(row["stroke_m"]):
            parts.append(f"stroke {1000 * row['stroke_m']:.1f} mm")
        lines.append(f"{row['name']}: {'; '.join(parts)}")
    return lines
