"""Limit states: what may become of an object, each declared once, read by curves, exports and figures."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from rockfrag.errors import InputError
from rockfrag.outcomes.outcomes import Outcomes

Predicate = Callable[[Outcomes], NDArray[np.bool_]]


@dataclass(frozen=True)
class LimitState:
    """One limit state.

    Attributes
    ----------
    name
        Short name, such as ``"overturns"``.
    order
        Its place among the others, the milder first.
    label
        What figures and reports call it.
    reached
        Which cases have reached it, shape (systems, motions, scales).
    """

    name: str
    order: int
    label: str
    reached: Predicate


_STATES: dict[str, LimitState] = {}


def limit_state(name: str, order: int, label: str) -> Callable[[Predicate], Predicate]:
    """Declare the function below as the predicate of a limit state.

    Parameters
    ----------
    name
        Short name.
    order
        Its place among the others, the milder first.
    label
        What figures and reports call it.

    Raises
    ------
    InputError
        If the name is taken.
    """

    def declare(predicate: Predicate) -> Predicate:
        if name in _STATES:
            raise InputError(
                f"limit state {name!r} is declared twice; give the second another name."
            )
        _STATES[name] = LimitState(name, order, label, predicate)
        return predicate

    return declare


def limit_states() -> tuple[LimitState, ...]:
    """Return all limit states, the milder first."""
    return tuple(sorted(_STATES.values(), key=lambda state: (state.order, state.name)))


def limit_state_named(name: str) -> LimitState:
    """Return the limit state of a name.

    Raises
    ------
    InputError
        If there is none.
    """
    if name not in _STATES:
        known = ", ".join(state.name for state in limit_states())
        raise InputError(f"limit state {name!r} is not known; choose one of {known}.")
    return _STATES[name]


def forget_limit_state(name: str) -> None:
    """Take back a declaration, as a plugin that is unloaded does."""
    _STATES.pop(name, None)


@limit_state("rocks", order=10, label="rocking")
def _rocks(outcomes: Outcomes) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        return np.asarray((outcomes.peak_rotation > 0).any(axis=-1))


@limit_state("slides", order=20, label="sliding")
def _slides(outcomes: Outcomes) -> NDArray[np.bool_]:
    with np.errstate(invalid="ignore"):
        return np.asarray((outcomes.peak_slip > 0).any(axis=-1))


@limit_state("overturns", order=90, label="overturning")
def _overturns(outcomes: Outcomes) -> NDArray[np.bool_]:
    return outcomes.overturned
