"""Limit states: what may become of an object, each declared once.

IDA curves have a column for each that is counted; curves, exports, figures and assessments read them by name.

In: :class:`rockfrag.outcomes.Outcomes`. Out: whether each case has reached a state. Docs: ``docs/definitions.md``.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from rockfrag.base.errors import InputError
from rockfrag.outcomes.outcomes import Outcomes
from rockfrag.system.system import System

Predicate = Callable[[Outcomes], NDArray[np.bool_]]

OVERTURNS = "overturns"  # name of the limit state that every IDA curve counts
LEANS = "leans"  # name of the limit state of what is held and rests beyond its balance
ROCKS = "rocks"  # name of the limit state that begins at an exactly known acceleration
# slip above which a body counts as having slid [m]: a displacement that one sees
VISIBLE = 0.001


@dataclass(frozen=True)
class LimitState:
    """One limit state.

    Attributes
    ----------
    name : short, such as ``"overturns"``
    order : its place among the others, the milder first
    label : what figures and reports call it
    reached : which cases have reached it, shape (systems, motions, scales)
    damage, repair : what it means for the object, and what is done then, for models of damage
    exact : whether it is reached at a peak acceleration that is known exactly, so that IDA curves do not count it
    slipping : whether only systems with friction reach it
    held : whether only systems with walls or ties reach it
    """

    name: str
    order: int
    label: str
    reached: Predicate
    damage: str = ""
    repair: str = ""
    exact: bool = False
    slipping: bool = False
    held: bool = False

    @property
    def column(self) -> str:
        """Name of its column in the table of an IDA curve."""
        return "overturned" if self.name == OVERTURNS else self.name

    def counted(self, system: System) -> bool:
        """Whether the IDA curve of a system has a column for it."""
        possible = (system.loose or not self.slipping) and (
            len(system.constraints) > 0 or not self.held
        )
        return not self.exact and possible


_STATES: dict[str, LimitState] = {}


def limit_state(
    name: str, order: int, label: str, **more: Any
) -> Callable[[Predicate], Predicate]:
    """Declare the function below as the predicate of a limit state.

    Parameters
    ----------
    name : one word, by which curves, exports and figures know it
    order, label, **more : see :class:`LimitState`

    Returns
    -------
    What takes the predicate and returns it as it is.
    """
    if not name.isidentifier():
        raise InputError(
            f"limit state {name!r}: expected one word of letters, digits and _."
        )

    def declare(predicate: Predicate) -> Predicate:
        """Register a predicate on outcomes as a limit state."""
        if name in _STATES:
            raise InputError(
                f"limit state {name!r} is declared twice; give the second another name."
            )
        _STATES[name] = LimitState(name, order, label, predicate, **more)
        return predicate

    return declare


def limit_states() -> tuple[LimitState, ...]:
    """All limit states that are declared.

    Returns
    -------
    The limit states, the milder first.
    """
    return tuple(sorted(_STATES.values(), key=lambda state: (state.order, state.name)))


def limit_state_named(name: str) -> LimitState:
    """Limit state of a name.

    Parameters
    ----------
    name : of a declared limit state

    Returns
    -------
    The limit state.
    """
    if name not in _STATES:
        known = ", ".join(state.name for state in limit_states())
        raise InputError(f"limit state {name!r} is not known; choose one of {known}.")
    return _STATES[name]


_PUT_BACK = "Inspect and put back"


@limit_state(
    ROCKS,
    10,
    "rocking",
    damage="Rocks and may be displaced",
    repair=_PUT_BACK,
    exact=True,
)
def _rocks(outcomes: Outcomes) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        return np.asarray((outcomes.peak_rotation > 0).any(axis=-1))


@limit_state(
    "slides",
    20,
    "sliding",
    damage="Slides and may be displaced",
    repair=_PUT_BACK,
    slipping=True,
)
def _slides(outcomes: Outcomes) -> NDArray[np.bool_]:
    """Whether a contact slips by what can be seen, or the body falls."""
    with np.errstate(invalid="ignore"):
        return (
            np.asarray((outcomes.peak_slip > VISIBLE).any(axis=-1))
            | outcomes.overturned
        )


@limit_state(
    LEANS,
    60,
    "leaning",
    damage="Leans against a wall or hangs in a tie",
    repair=_PUT_BACK,
    held=True,
)
def _leans(outcomes: Outcomes) -> NDArray[np.bool_]:
    return np.asarray(outcomes.leaning | outcomes.overturned)


@limit_state(
    OVERTURNS,
    90,
    "overturning",
    damage="Overturned",
    repair="Restore or replace the object",
)
def _overturns(outcomes: Outcomes) -> NDArray[np.bool_]:
    return outcomes.overturned
