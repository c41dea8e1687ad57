"""Options of ``rockfrag simulate`` that say what holds a body, and the lines on what they had to bear.

In: options as they are typed.  Out: a system with walls, ties, bonds and an isolator (``docs/holding.md``).
"""

import argparse
import math
from typing import TYPE_CHECKING, Any

from rockfrag.base.errors import InputError
from rockfrag.base.units import quantity

if TYPE_CHECKING:
    from rockfrag.system.support import Support
    from rockfrag.system.system import System

RATIO = ""
# least number of values of each option, and the unit of each value without one
UNITS: dict[str, tuple[int, tuple[str, ...]]] = {
    "wall": (1, ("m", "m")),
    "kerb": (2, ("m", "m")),
    "putty": (1, ("N", "N", "m")),
    "cord": (1, ("N_m", "m", "N")),
    "bracket": (1, ("N_m", "m", "N")),
    "pendulum": (2, ("m", RATIO, "m", "kg")),
    "springs": (2, ("N_m", "N", "m", "kg")),
}
OPTIONS = (*UNITS, "casters")


def add_holding_options(command: argparse.ArgumentParser) -> None:
    """Add the options that say what holds a body.

    Parameters
    ----------
    command : parser of the command
    """
    several: dict[str, Any] = {"nargs": "+"}
    command.add_argument(
        "--wall", **several, metavar="GAP",
        help="gap to a wall on the right, and perhaps to one on the left, such as 2cm",
    )  # fmt: skip
    command.add_argument(
        "--kerb", nargs=2, metavar="SIZE",
        help="gap to a kerb on the right, and its height, such as 1cm 10cm",
    )  # fmt: skip
    command.add_argument(
        "--putty", **several, metavar="PULL",
        help="pull that putty under the uppermost body bears, such as 120N, perhaps what it bears in shear, and "
        "half the distance of its pads, such as 12cm",
    )  # fmt: skip
    for name, words in (
        ("cord", "two cords from its top to both sides"),
        ("bracket", "a bracket from its top to a wall"),
    ):
        command.add_argument(
            f"--{name}", **several, metavar="STIFFNESS",
            help=f"stiffness of {words}, such as 50kN/m, perhaps slack, such as 2mm, and strength, such as 500N",
        )  # fmt: skip
    command.add_argument(
        "--pendulum", **several, metavar="RADIUS",
        help="isolator under it: radius of its dish, such as 2m, friction, perhaps stroke to its stop, such as "
        "20cm, and mass of its plate, such as 30kg",
    )  # fmt: skip
    command.add_argument(
        "--springs", **several, metavar="STIFFNESS",
        help="bilinear isolator under it: stiffness after it yields, such as 4kN/m, force at which it yields, "
        "such as 60N, perhaps stroke to its stop, and mass of its plate",
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
    The system; the same one where nothing holds it.
    """
    if not is_held(options):
        return system
    from rockfrag.system import hold, mounts

    constraints: list[Any] = []
    for gap, side in zip(_given(options, "wall"), (1, -1), strict=False):
        constraints.append(mounts.wall_beside(system, gap, side))
    if options.kerb is not None:
        gap, height = _given(options, "kerb")
        constraints.append(mounts.wall_beside(system, gap, height=height))
    if options.cord is not None:
        constraints += mounts.cords_at_top(system, *_given(options, "cord"))
    if options.bracket is not None:
        springs = _given(options, "bracket")
        constraints.append(mounts.bracket_at_top(system, *springs))
    putty = _given(options, "putty")
    bond = mounts.putty_under(system, *putty) if putty else None
    if options.casters is not None:
        system = mounts.on_casters(system, options.casters)
    support = _isolator(options, system.mass)
    return hold(system, *constraints, bonds=bond, support=support)


def _isolator(options: argparse.Namespace, carried: float) -> "Support | None":
    """Return the isolator of the options under a mass [kg], if there is one."""
    from rockfrag.assess.core.holding import PLATE
    from rockfrag.system import BilinearIsolator, SlidingPendulum
    from rockfrag.system.contact import checked_friction

    if options.pendulum is not None and options.springs is not None:
        raise InputError("--springs: there is a --pendulum already; leave out one.")
    for name in ("pendulum", "springs"):
        if getattr(options, name) is None:
            continue
        first, second, *more = _given(options, name)
        stroke = more[0] if more else math.inf
        mass = more[1] if len(more) > 1 else PLATE * carried
        if name == "springs":
            return BilinearIsolator(
                mass=mass, stroke=stroke, stiffness=first, strength=second
            )
        mu = checked_friction("--pendulum", second)
        return SlidingPendulum(mass=mass, stroke=stroke, radius=first, friction=mu)
    return None


def _given(options: argparse.Namespace, name: str) -> list[float]:
    """Return the numbers of an option in SI; none if it was not given."""
    typed: list[str] = getattr(options, name) or []
    least, units = UNITS[name]
    if typed and not least <= len(typed) <= len(units):
        raise InputError(
            f"--{name}: expected {least} to {len(units)} numbers, got {len(typed)}."
        )
    try:
        return [_number(each, unit) for each, unit in zip(typed, units, strict=False)]
    except InputError as error:
        raise InputError(f"--{name}: {error}") from None


def _number(typed: str, unit: str) -> float:
    """Return a number in SI, typed with a unit or without one; ratios have none."""
    try:
        plain = float(typed)
    except ValueError:
        plain = math.nan
    if unit == RATIO:
        if math.isnan(plain):
            raise InputError(f"expected a number such as 0.05, found {typed!r:.60}.")
        return plain
    return quantity(typed if math.isnan(plain) else plain, unit, unit)


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
        # of an isolator the displacement counts, and no force is kept
        is_support = not math.isnan(row["stroke_m"])
        parts = [] if is_support else [f"largest force {row['largest_force_n']:.0f} N"]
        if row["hits"]:
            parts.append(
                f"{row['hits']} hits, the hardest {row['largest_impulse_n_s']:.1f} N s"
            )
        if not math.isnan(row["breaking_time_s"]):
            parts.append(f"broke at {row['breaking_time_s']:.3f} s")
        if is_support:
            parts.append(f"stroke {1000 * row['stroke_m']:.1f} mm")
        lines.append(f"{row['name']}: {'; '.join(parts)}")
    return lines
