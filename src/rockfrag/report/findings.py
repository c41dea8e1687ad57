"""What a study found, said of its tables; the sentences stand in ``findings.j2``."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import pandas as pd

from rockfrag.fragility.curve_facts import Compared, compared_curves
from rockfrag.report import wording
from rockfrag.report.part import Finding, finding_of
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.study.study import Study

FRICTION = 0.6
"""Coefficient of friction of dry stone on stone, with which demands are compared [-]."""

_RATIO_DECIMALS = 3


@dataclass(frozen=True)
class Sides:
    """Two sides of a comparison."""

    change: str = "the pedestal"  # Subject of a sentence about what the difference does
    ratio: str = "with/without pedestal"  # The ratio of amplitudes
    # An arrangement and its counterpart, after "amplitude"
    first: str = "with pedestal"
    second: str = "without pedestal"

    @property
    def divided(self) -> str:
        """The ratio in a sentence."""
        return f"Amplitude {self.first} divided by that {self.second.removesuffix(' pedestal')}"

    @property
    def both(self) -> str:
        """The two sides."""
        return f"{self.first.removesuffix(' pedestal')} and {self.second}"

    @property
    def axis(self) -> str:
        """Label of an axis of ratios."""
        if self == Sides():
            return "Amplitude with / without pedestal"
        return "Amplitude over the other's"


WITH_PEDESTAL = Sides()
"""What is compared unless arrangements name their counterparts."""


def sides_of(study: Study) -> Sides:
    """Return what is compared in a study."""
    named = study.counterparts
    if not named:
        return WITH_PEDESTAL
    ((name, other), *more) = named.items()
    if more or study.with_and_alone:
        return Sides(
            "an arrangement instead of the one it is compared with",
            "arrangement/the other",
            "of an arrangement",
            "of the other",
        )
    return Sides(f"{name} instead of {other}", f"{name}/{other}", f"of {name}", f"of {other}")


def _finding(name: str, **about: Any) -> Finding:
    """What a macro says."""
    return finding_of(getattr(says, name)(**about))


def strength_found(curves: pd.DataFrame, level: str) -> Finding | None:
    """Say at which peak each configuration overturns with a probability of one half; None without a curve."""
    if curves.empty:
        return None
    found = headline_curves(curves)
    rows = found.rows[found.rows["theta"].notna()]
    if rows.empty:
        return None
    decimals = min(max(wording.decimals_of(value, 2) for value in rows["theta"]), 3)
    texts = wording.estimates(rows, "theta", decimals)
    printed = [wording.number(value, decimals) for value in rows["theta"]]
    least, most = (
        printed[int(place)] for place in (rows["theta"].argmin(), rows["theta"].argmax())
    )
    # what differs in no digit that is shown is named together
    low, high = (
        [name for name, text in zip(rows["configuration"], printed, strict=True) if text == end]
        for end in (least, most)
    )
    return _finding(
        "strength",
        measure=rows["im"].iloc[0],
        unit=rows["unit"].iloc[0],
        low=low,
        high=high,
        least=least,
        most=most,
        named=[f"{name} {text}" for name, text in zip(rows["configuration"], texts, strict=True)],
        level=level,
        rejected=found.rejected,
        nonparametric=found.nonparametric,
    )


def headline_curves(curves: pd.DataFrame) -> Compared:
    """Curves that the first page compares: of the first measure, all outcomes counted, by one estimator."""
    first = curves["im"] == (curves["im"].iloc[0] if len(curves) else "")
    known = curves[first & (curves["estimator"] == "mean_probability") & curves["theta"].notna()]
    return compared_curves(known)


ONE_MOTION = Finding(
    "One motion: no fragility can be given",
    "A fragility needs the motions of several earthquakes; one of them says nothing about how much they differ.",
)
"""Said in place of curves where a study has a single record."""


def recorded_found(recorded: pd.DataFrame) -> Finding:
    """Say what the motions as recorded overturn, and how much that depends on their exact strength."""
    by_name = recorded.groupby("configuration", sort=False)["overturned"].agg(["sum", "size"])
    counts = {str(name): int(n) for name, n in by_name["sum"].items()}
    return _finding(
        "recorded",
        counts=counts,
        low=min(counts, key=counts.__getitem__),
        high=max(counts, key=counts.__getitem__),
        motions=int(by_name["size"].max()),
        fallen=int(recorded["overturned"].sum()),
        total=len(recorded),
        near=int(recorded["fraction_near"].between(0, 1, inclusive="neither").sum()),
    )


def amplitudes_found(tests: pd.DataFrame) -> Finding:
    """Say how many tests overturn, at which amplitudes, and what fell."""
    known = tests["amplitude_g"].notna()
    on_pedestal = tests[(tests["pedestal"] == "P") & (tests["overturned_body"] != "")]
    fell = on_pedestal["overturned_body"]
    itself = fell.isin(["statue"]) | (fell == on_pedestal["object"])
    return _finding(
        "amplitudes",
        tests=tests,
        known=tests.loc[known, "amplitude_g"],
        first=list(tests.loc[~known & tests["upper_g"].notna(), "test"]),
        never=list(tests.loc[~known & tests["upper_g"].isna(), "test"]),
        below=int((~itself).sum()),
        on_pedestal=len(on_pedestal),
    )


def objects_compared(means: pd.DataFrame, slenderness: Mapping[str, float]) -> list[Finding]:
    """Say whether more slender objects overturn at lower amplitudes, where there are two of them or more."""
    rows = means[(means["by"] == "configuration") & means["mean_g"].notna()]
    parts, falling, most = [], [], 0
    for side, words in (("NP", "alone"), ("P", "on a pedestal")):
        own = rows[rows["pedestal"] == side]
        own = own.assign(slenderness=own["object"].map(slenderness))
        own = own.sort_values("slenderness", kind="stable")
        if own["slenderness"].nunique() < 2:
            continue
        each = wording.listed(
            [
                f"{row['configuration']} {wording.number(row['mean_g'], 3)} g"
                for row in own.to_dict("records")
            ]
        )
        parts.append(f"{words} {each}")
        falling.append(bool((np.diff(own["mean_g"].to_numpy(dtype=float)) < 0).all()))
        most = max(most, int(own["motions"].max()))
    if not parts:
        return []
    return [_finding("slenderness", falling=all(falling), most=most, parts=parts)]


def mean_sentence(means: pd.DataFrame) -> str:
    """Say over which motions means are taken, and which had to be left out."""
    rows = means[means["by"] == "configuration"]
    most, of = int(rows["motions"].max()), int(rows["of"].max())
    return wording.one_line(says.means(most, of))


def resurrections_found(resurrections: pd.DataFrame, tests: pd.DataFrame) -> Finding:
    """Say how often an object survives a stronger motion than one that overturned it."""
    fallen = resurrections[resurrections["first_upper"].notna()]
    wide = tests.pivot_table(index="test", columns="definition", values="amplitude_g")
    both = wide.reindex(columns=["first_overturning", "always_overturning"]).dropna().astype(float)
    factor = np.log(both["always_overturning"] / both["first_overturning"]).mean()
    return _finding(
        "resurrections",
        fallen=len(fallen),
        survived=int((fallen["resurrections"] > 0).sum()),
        factor=float(np.exp(factor)),
        both=len(both),
    )


def ratio_text(row: Mapping[Any, Any]) -> str:
    """A ratio with its interval: ``1.010 [0.990, 1.030]``."""
    return wording.estimate(row["ratio"], row["lower"], row["upper"], _RATIO_DECIMALS)


says = wording.Macros(
    "rockfrag.report",
    "findings.j2",
    {
        "FRICTION": FRICTION,
        "MOST_CONFIGURATIONS": 6,  # so many are named with their numbers in a sentence
        "RATIO_DECIMALS": _RATIO_DECIMALS,
        "analyses": lambda n, total: wording.of_all(n, total, "analysis", "analyses"),
        "has_interval": wording.has_interval,
        "ratio_text": ratio_text,
    },
)


def ratio_of(effects: pd.DataFrame, about: Sides = WITH_PEDESTAL) -> Callable[[str, str], str]:
    """Return a function of scope and level that words the ratio of amplitudes there."""
    rows = effects[effects["definition"] == DEFINITION] if len(effects) else effects

    def text(scope: str, level: str) -> str:
        found = rows[(rows["scope"] == scope) & (rows["level"] == level)] if len(rows) else rows
        if found.empty:
            return "no pair with both amplitudes known"
        row = found.to_dict("records")[0]
        return f"{about.ratio} {wording.estimate(row['ratio'], row['lower'], row['upper'], 2)}"

    return text


def pedestal_effect(effects: pd.DataFrame, about: Sides = WITH_PEDESTAL) -> list[Finding]:
    """Say by what factor what is compared changes the amplitude, over all pairs and on each floor."""
    whole = effects[effects["scope"] == "whole"]
    here = whole[whole["definition"] == DEFINITION]
    if here.empty:
        return [_finding("no_effect", about=about)]
    row = here.to_dict("records")[0]
    others = whole[whole["definition"] != DEFINITION].to_dict("records")
    floors = effects[(effects["scope"] == "floor") & (effects["definition"] == DEFINITION)]
    return [_finding("effect", row=row, about=about, others=others), *_by_floor(floors, about)]


def _by_floor(rows: pd.DataFrame, about: Sides) -> list[Finding]:
    if len(rows) < 2:
        return []
    limits = rows[["lower", "upper"]].to_numpy(dtype=float)
    known = np.array([wording.has_interval(low, high, _RATIO_DECIMALS) for low, high in limits])
    clear = known & ((rows["lower"] > 1) | (rows["upper"] < 1))
    each = rows.to_dict("records")
    return [_finding("floors", rows=each, known=known.any(), clear=int(clear.sum()), about=about)]


def model_allowed(validity: pd.DataFrame) -> list[Finding]:
    """Say how much friction rocking without sliding needs, and whether a block would have jumped."""
    if validity.empty:
        return []
    found = _finding(
        "model",
        headline=friction_sentence(validity),
        demands=_demands(validity),
        beyond=int((~np.isfinite(validity["friction_demand"].astype(float))).sum()),
        lifted=int((validity["least_normal_force_n"] <= 0).sum()),
        tests=len(validity),
    )
    return [found]


_WHERE = {"P": "with the pedestal", "NP": "without"}


def _sides(validity: pd.DataFrame) -> dict[str, pd.DataFrame]:
    """Tests by where they were made, where both sides were tested; else all of them."""
    sides = {where: validity[validity["pedestal"] == side] for side, where in _WHERE.items()}
    return {"": validity} if any(part.empty for part in sides.values()) else sides


def friction_sentence(validity: pd.DataFrame) -> str:
    """Say how many tests need more friction than dry stone has, with and without a pedestal; no full stop."""
    beyond = [
        (int((~(part["friction_demand"].astype(float) <= FRICTION)).sum()), len(part), where)
        for where, part in _sides(validity).items()
    ]
    return wording.one_line(says.friction(beyond))


def _demands(validity: pd.DataFrame) -> list[str]:
    """Range and median of the friction needed, with and without a pedestal where both were tested."""
    words = []
    for where, part in _sides(validity).items():
        demand = part["friction_demand"].to_numpy(dtype=float)
        known = demand[np.isfinite(demand)]
        if known.size == 0:
            continue
        span = f"{known.min():.2f} to {known.max():.2f} (median {np.median(known):.2f})"
        words.append(f"{where} {span if known.size > 1 else f'{known[0]:.2f}'}".strip())
    return words or ["none known"]


def sliding_found(sliding: pd.DataFrame) -> Finding:
    """Say in how many analyses bodies slid and flew, how far, and how many outcomes that changed."""
    counts = {
        name: int(sliding[name].sum()) for name in ("cases", "slid", "flew", "saved", "felled")
    }
    where = max(sliding.to_dict("records"), key=lambda row: float(row["largest_slip_m"]))
    slip = 100 * where["largest_slip_m"]
    return _finding("sliding", **counts, slip_cm=slip, where=where["configuration"])
