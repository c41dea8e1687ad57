"""Pairing of tests: the same object and motion, with (P) and without (NP) the pedestal.

In: a table of tests with amplitudes [g]. Out: :class:`Pairs`, with d [-] and its resolution. Theory:
``docs/pedestal.md``, "What a series of steps can know".

The unit of everything that follows is d = ln a_P - ln a_NP of one pair.  An amplitude from a series of steps lies
anywhere in its step, so d is known to its ``resolution``: half the two steps' widths together, ln(1 + step) where
both sides climbed the same series of levels.  A test that never overturned bounds d on one side.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.base.arrays import Flags
from rockfrag.base.errors import InputError
from rockfrag.base.short_repr import short_repr
from rockfrag.effects.notes import notes_on_left_out

KEY = ["object", "earthquake", "floor", "motion"]
CHANGED, PLAIN = "P", "NP"
"""Sides of a pair as the column ``pedestal`` writes them: on the pedestal and alone, or an arrangement and the one
that it is compared with (:func:`with_counterparts`)."""

_NEEDED = ("object", "pedestal", "earthquake", "floor", "amplitude_g")


@dataclass(frozen=True)
class Pairs:
    """Tests sorted into pairs.

    Parameters
    ----------
    table
        One row per pair: object, earthquake, floor, motion, slenderness, s_c (slenderness less the mean of
        the objects'; both NaN where it is not known), a_np_g, a_p_g [g], d, resolution (half-width to
        which d is known [-]; 0 where amplitudes came without brackets), bound ("at least" or "at most"
        where one of the tests never overturned and d is the bound that follows, else empty).
    censored, unpaired
        Object, earthquake, floor, motion of pairs of which a test never overturned; d_lower, d_upper (infinite
        if unbounded; not in ``table`` if both are), and of tests without a partner; missing ("P" or "NP").
    """

    table: pd.DataFrame
    censored: pd.DataFrame
    unpaired: pd.DataFrame

    __repr__ = short_repr

    def notes(self) -> list[str]:
        """Notes on what is not among the complete pairs."""
        bounded = self.table[self.table["bound"] != ""]
        below, above = self.censored["d_lower"], self.censored["d_upper"]
        lost = self.censored[np.isneginf(below) & np.isposinf(above)]
        return notes_on_left_out(
            bounded.to_dict("records"),
            lost.to_dict("records"),
            self.unpaired.to_dict("records"),
        )


def check_tests(tests: pd.DataFrame) -> pd.DataFrame:
    """Check a table of tests, or say which row cannot be used.

    Parameters
    ----------
    tests : a row a test

    Returns
    -------
    A clean copy. Tests have object, pedestal ("P" or "NP"), earthquake, floor, amplitude_g [g] and, where
    present, motion, lower_g, upper_g [g], censored ("none", "right"; "left" for a test that overturned at its
    first step, lower_g 0), repetition, definition. Absent columns are filled in, and rows are sorted so that
    results do not depend on their order.
    """
    missing = [name for name in _NEEDED if name not in tests.columns]
    if missing:
        raise InputError(
            f"Table of tests: column(s) {', '.join(missing)} missing; it needs {', '.join(_NEEDED)}."
        )
    if tests.empty:
        raise InputError(
            "Table of tests: it has no rows; give at least one test per line."
        )
    clean = _filled_in(tests)
    for name, allowed in (
        ("pedestal", (CHANGED, PLAIN)),
        ("censored", ("none", "right", "left")),
    ):
        known = ", ".join(allowed)
        _refuse(
            clean,
            ~clean[name].isin(allowed),
            name,
            f"is {{!r}}; it must be one of {known}.",
        )
    definitions = sorted(set(clean.get("definition", pd.Series(dtype=str)).astype(str)))
    if len(definitions) > 1:
        raise InputError(
            "Table of tests: several definitions of the same IDA curve are mixed "
            f"({', '.join(definitions)}); keep one of them."
        )
    _check_amplitudes(clean)
    test = [*KEY, "pedestal", "repetition"]
    _refuse_twice(clean, test)
    return clean.sort_values(test, kind="stable", ignore_index=True)


def _filled_in(tests: pd.DataFrame) -> pd.DataFrame:
    """A copy with text in the columns that say which test it is, and the usual in columns that are absent."""
    clean = tests.reset_index(drop=True).copy()
    for name in ("object", "pedestal", "earthquake", "floor"):
        _refuse(clean, clean[name].isna(), name, "is empty; fill it in.")
        clean[name] = clean[name].astype(str)
    if "motion" not in clean:
        clean["motion"] = clean["earthquake"] + "/" + clean["floor"]
    for name, usual in (("censored", "none"), ("repetition", 1)):
        if name not in clean:
            clean[name] = usual
    clean["censored"] = clean["censored"].fillna("none").astype(str)
    return clean


def _refuse_twice(tests: pd.DataFrame, key: Sequence[str]) -> None:
    """Refuse a test that stands in two rows, by the columns that say which one it is."""
    test = list(key)
    twice = np.flatnonzero(tests.duplicated(test))
    if len(twice):
        row = tests.loc[twice[0], test]
        first = int(np.flatnonzero((tests[test] == row).all(axis=1))[0])
        raise InputError(
            f"Table of tests, row {twice[0] + 1}: the same test as row {first + 1} "
            f"({', '.join(row[['object', 'motion', 'pedestal']])}); remove one or number them in the column "
            "repetition."
        )


def _refuse(
    tests: pd.DataFrame, bad: "pd.Series[bool]", column: str, what: str
) -> None:
    """Refuse the first bad row of a table of tests; the text may name the value in the column."""
    if bad.any():
        row = int(bad.to_numpy().argmax())
        value = tests[column].iloc[row]
        raise InputError(
            f"Table of tests, row {row + 1}: {column} {what.format(value)}"
        )


def _check_amplitudes(clean: pd.DataFrame) -> None:
    """Fill bounds in and refuse amplitudes that are no positive numbers."""
    for name in ("amplitude_g", "lower_g", "upper_g"):
        if name not in clean:
            clean[name] = clean["amplitude_g"]
        numbers = pd.to_numeric(clean[name], errors="coerce")
        bad = numbers.isna() & clean[name].notna()
        _refuse(clean, bad, name, "is {!r}, not a number of g.")
        clean[name] = numbers.astype(float)
    at_once = (
        clean["amplitude_g"].isna() & (clean["lower_g"] == 0) & (clean["upper_g"] > 0)
    )
    clean.loc[at_once & (clean["censored"] == "none"), "censored"] = "left"
    right, left = clean["censored"] == "right", clean["censored"] == "left"
    clean.loc[left, "lower_g"] = 0.0
    clean.loc[~right, "lower_g"] = clean["lower_g"].fillna(clean["amplitude_g"])
    clean.loc[~right, "upper_g"] = clean["upper_g"].fillna(clean["amplitude_g"])
    for name, here in (
        ("amplitude_g", ~(right | left)),
        ("lower_g", right),
        ("upper_g", left),
    ):
        known = np.isfinite(clean[name]) & (clean[name] > 0)
        words = (
            "is {}; give the positive number of g at which the test overturned, or censored = right with the "
            "largest amplitude survived as lower_g."
        )
        _refuse(clean, here & ~known, name, words)
    crossed = (~right & ~(clean["lower_g"] <= clean["upper_g"])).to_numpy()
    if crossed.any():
        row = int(crossed.argmax())
        lower, upper = clean[["lower_g", "upper_g"]].iloc[row]
        raise InputError(
            f"Table of tests, row {row + 1}: lower_g {lower} exceeds upper_g {upper}; exchange them."
        )


def pedestals_apart(tests: pd.DataFrame) -> tuple[pd.DataFrame, dict[str, str]]:
    """Give each pedestal of an object that has several its own pairs with the lone object.

    Such an object is named after the ``configuration`` instead, and its tests without pedestal stand beside each.

    Parameters
    ----------
    tests : a row a test

    Returns
    -------
    The tests, and the object by each such name.
    """
    if not {"configuration", "object", "pedestal"} <= set(tests.columns):
        return tests, {}
    on_pedestal = tests[tests["pedestal"] == CHANGED]
    names = on_pedestal.groupby("object")["configuration"].unique()
    several = names[names.map(len) > 1]
    parts = [tests[~tests["object"].isin(list(several.index))]]
    origin: dict[str, str] = {}
    for object_name, configurations in several.items():
        rows = tests[tests["object"] == object_name]
        for name in configurations:
            here = (rows["pedestal"] == PLAIN) | (rows["configuration"] == name)
            parts.append(rows[here].assign(object=name))
            origin[str(name)] = str(object_name)
    return pd.concat(parts, ignore_index=True), origin


def with_counterparts(
    tests: pd.DataFrame, counterparts: Mapping[str, str]
) -> tuple[pd.DataFrame, dict[str, str]]:
    """Let arrangements that name their counterpart be compared with it instead of with the object alone.

    The rows of each such comparison stand for an object of their own, with the arrangement as P and its
    counterpart as NP.

    Parameters
    ----------
    tests, counterparts : a row a test, and the counterpart by the name of the arrangement

    Returns
    -------
    The tests, and the object by the name of each comparison.
    """
    parts = [tests[~tests["configuration"].isin(list(counterparts))]]
    origin: dict[str, str] = {}
    for name, other in counterparts.items():
        label = f"{name} against {other}"
        own = tests[tests["configuration"] == name]
        others = tests[tests["configuration"] == other]
        parts += [
            own.assign(object=label, pedestal=CHANGED),
            others.assign(object=label, pedestal=PLAIN),
        ]
        if len(own):
            origin[label] = str(own["object"].iloc[0])
    return pd.concat(parts, ignore_index=True), origin


def slenderness_of(clean: pd.DataFrame, slenderness: Mapping[str, float]) -> pd.Series:
    """Slenderness of each row's object [-]."""
    unknown = sorted(set(clean["object"]) - set(slenderness))
    if unknown:
        raise InputError(
            f"Table of tests: the slenderness of object {unknown[0]} is not known; "
            f"give it (known are {', '.join(slenderness)})."
        )
    return clean["object"].map(slenderness).astype(float)


def _sides(clean: pd.DataFrame) -> pd.DataFrame:
    """One row per object and motion, columns by figure and side; repetitions averaged in ln a.

    The mean of repetitions of which one never overturned is only known to lie above the mean of what was survived,
    so such a side counts as censored; likewise below, where one overturned at its first step.
    """
    exact, left = clean["censored"] == "none", clean["censored"] == "left"
    figure = clean["amplitude_g"].where(
        exact, clean["lower_g"].where(~left, clean["upper_g"])
    )
    work = clean.assign(
        ln_a=np.log(figure),
        # a step that begins at zero has no width in the logarithm: only its end is known
        width=np.log(clean["upper_g"])
        - np.log(clean["lower_g"].where(clean["lower_g"] > 0)),
        right=clean["censored"] == "right",
        left=left,
    )
    work["width"] = work["width"].where(exact)
    how: dict[str, Any] = {
        "ln_a": "mean",
        "width": "mean",
        "right": "any",
        "left": "any",
    }
    sides = work.pivot_table(list(how), KEY, "pedestal", how)
    return sides.reindex(columns=pd.MultiIndex.from_product([how, (CHANGED, PLAIN)]))


def _open_ends(sides: pd.DataFrame) -> tuple[Flags, Flags]:
    """Whether d = ln a_P - ln a_NP of each pair may be larger, and smaller, than its figure.

    It may be larger where P lies above its figure or NP below its own, and smaller the other way round.
    """
    lies_above = pd.DataFrame(sides["right"]).eq(True)
    lies_below = pd.DataFrame(sides["left"]).eq(True)
    upward = (lies_above[CHANGED] | lies_below[PLAIN]).to_numpy()
    downward = (lies_above[PLAIN] | lies_below[CHANGED]).to_numpy()
    return upward, downward


def pair_tests(
    tests: pd.DataFrame, slenderness: Mapping[str, float] | None = None
) -> Pairs:
    """Pair tests with and without pedestal by object and motion.

    Parameters
    ----------
    tests : a row a test, see :func:`check_tests`
    slenderness : height over width by object [-], needed only for slopes on it

    Returns
    -------
    The :class:`Pairs`.
    """
    tests, origin = pedestals_apart(tests)
    clean = check_tests(tests)
    slenderness = _slenderness_by_name(clean, slenderness, origin)
    sides = _sides(clean)
    ln_a = pd.DataFrame(sides["ln_a"]).astype(float)
    width = pd.DataFrame(sides["width"]).astype(float)
    upward, downward = _open_ends(sides)
    both = ln_a.notna().all(axis=1).to_numpy()
    if not both.any():
        raise InputError(
            "Table of tests: no object was tested under the same motion with and without pedestal; "
            "check the columns object, motion and pedestal."
        )
    frame = pd.DataFrame(
        {"a_np_g": np.exp(ln_a[PLAIN]), "a_p_g": np.exp(ln_a[CHANGED])}
    ).assign(
        d=ln_a[CHANGED] - ln_a[PLAIN],
        # a censored side takes its partner's step; without any step the figures count as exact
        resolution=width.mean(axis=1).fillna(0.0),
        bound=np.select(
            [upward & ~downward, downward & ~upward], ["at least", "at most"], ""
        ),
    )
    frame = frame.reset_index()
    frame.insert(4, "slenderness", slenderness_of(frame, slenderness))
    centre = float(
        np.mean([slenderness[name] for name in sorted(frame["object"].unique())])
    )
    frame.insert(5, "s_c", frame["slenderness"] - centre)
    alone = frame.loc[~both, KEY].assign(
        missing=np.where(ln_a[CHANGED].isna(), CHANGED, PLAIN)[~both]
    )
    limits = frame[KEY].assign(
        d_lower=np.where(downward, -np.inf, frame["d"]),
        d_upper=np.where(upward, np.inf, frame["d"]),
    )
    return Pairs(
        table=frame[both & ~(upward & downward)].reset_index(drop=True),
        censored=limits[both & (upward | downward)].reset_index(drop=True),
        unpaired=alone.reset_index(drop=True),
    )


def _slenderness_by_name(
    clean: pd.DataFrame,
    slenderness: Mapping[str, float] | None,
    origin: Mapping[str, str],
) -> dict[str, float]:
    """Slenderness of all names in a table of tests; NaN where none was given.

    ``origin`` is the object by the name of each of its pedestals, where it has several.
    """
    if slenderness is None:
        return dict.fromkeys(clean["object"].unique(), math.nan)
    by_pedestal = {
        name: slenderness[tested]
        for name, tested in origin.items()
        if tested in slenderness
    }
    known = {**slenderness, **by_pedestal}
    slenderness_of(clean, known)
    return known
