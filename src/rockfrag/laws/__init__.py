"""Laws of impacts: what a contact does when it closes, one file a law (``docs/restitution.md``).

A file ends with ``LAW = declare(...)``: its name, what the kernels get of a measured restitution, and the
rate at which it lets a contact come off, a function that the kernels inline.  A new law is one file and its name
in ``BUILT_IN``; a law without a rate of its own only makes the number of another law of what was measured.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from operator import attrgetter

from rockfrag.base.errors import InputError
from rockfrag.system.geometry import Shape

BUILT_IN = ("momentum", "position", "couple", "ratio")
"""Files of the laws, in the order of the numbers by which the kernels know them; the second is the usual one."""

ForKernels = tuple[int, float]
"""What the kernels get of the impacts that end on a pivot: number of a law, and the law's own number."""

Rate = Callable[[float, float, float, float], float]


@dataclass(frozen=True)
class Law:
    """One law of impacts."""

    name: str  # Name in files and messages
    number: int  # Number by which the kernels know it
    # Function of the shape of the lone body, its measured ratio of the angular velocities after and
    # before an impact [-] and the pivot on which the impact ends: what the kernels get
    tell: Callable[[Shape, float, int], ForKernels]
    # Function that the kernels inline: of the law's number, the rate at which momentum lets the
    # contact come off, the rate before the impact and the one that impulses moved as the law says
    # leave, the rate at which the contact comes off [rad/s, or m/s]. None: of another law
    rate: Rate | None = None
    # Whether the law's number is where the impulse acts, from the middle (0) to the new pivot (1) of the base
    moves_impulse: bool = False
    # Whether the law multiplies what momentum leaves, so that it has nothing to say where that is nothing
    scales_momentum: bool = False


_LAWS: dict[str, Law] = {}


def declare(
    name: str,
    tell: Callable[[Shape, float, int], ForKernels],
    rate: Rate | None = None,
    **more: bool,
) -> Law:
    """Declare a law (:class:`Law`), with a rate before anything is simulated: kernels are compiled with it."""
    if name in _LAWS:
        raise InputError(
            f"law of impacts {name!r} is declared twice; give the second another name."
        )
    last = max(len(BUILT_IN) - 1, *(law.number for law in _LAWS.values()), 0)
    number = BUILT_IN.index(name) if name in BUILT_IN else last + 1
    law = Law(name, number, tell, rate, **more)
    _LAWS[name] = law
    return law


def laws() -> tuple[Law, ...]:
    """Return all laws, conservation of momentum first."""
    for name in BUILT_IN:
        import_module(f"{__name__}.{name}")
    return tuple(sorted(_LAWS.values(), key=attrgetter("number")))


def law_names() -> tuple[str, ...]:
    """Return the names of the laws that a measured restitution may follow, the usual one first."""
    return tuple(law.name for law in laws()[1:])


def law_named(name: str) -> Law:
    """Return the law of a name."""
    laws()
    if name not in _LAWS:
        raise InputError(
            f"restitution: the law {name!r} is none of {', '.join(law_names())}."
        )
    return _LAWS[name]
