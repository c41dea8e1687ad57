"""What a study found, said of its tables; the sentences stand in ``findings.j2``."""

from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
import pandas as pd

from rockfrag.fragility.curve_facts import Compared, compared_curves
from rockfrag.report.part import Finding, Says
from rockfrag.shaketable.definitions import DEFINITION
from rockfrag.study.study import Study
from rockfrag.words import sentences as wording

# coefficient of friction of dry stone on stone, with which demands are compared [-]
FRICTION = 0.6

_RATIO_DECIMALS = 3


class Sides(NamedTuple):
    """Two sides of a comparison."""

    change: str = "the pedestal"  # Subject of a sentence about what the difference does
    ratio: str = "with/without pedestal"  # The ratio of amplitudes
    # An arrangement and its counterpart, after "amplitude"
    first: str = "with pedestal"
    second: str = "without pedestal"


WITH_PEDESTAL = Sides()  # what is compared unless arrangements name their counterparts


OF_ARRANGEMENTS = Sides(
    "an arrangement instead of the one it is compared with",
    *("arrangement/the other", "of an arrangement", "of the other"),
)


def sides_of(study: Study) -> Sides:
    """Return what is compared in a study."""
    if not study.counterparts:
        return WITH_PEDESTAL
    ((name, other), *more) = study.counterparts.items()
    if more or study.with_and_alone:
        return OF_ARRANGEMENTS
    return Sides(
        f"{name} instead of {other}", f"{name}/{other}", f"of {name}", f"of {other}"
    )


def strength_found(curves: pd.DataFrame, level: str) -> Finding | None:
    """Say at which peak each configuration overturns with a probability of one half; None without a curve."""
    if curves.empty:
        return None
    found = headline_curves(curves)
    rows = found.rows[found.rows["theta"].notna()]
    if rows.empty:
        return None
    decimals = min(max(wording.decimals_of(value, 2) for value in rows["theta"]), 3)
    named = rows["configuration"] + " " + wording.estimates(rows, "theta", decimals)
    printed = rows["theta"].map(lambda value: wording.number(value, decimals))
    ends = [
        wording.number(value, decimals)
        for value in (rows["theta"].min(), rows["theta"].max())
    ]
    # what differs in no digit that is shown is named together
    low, high = (list(rows.loc[printed == end, "configuration"]) for end in ends)
    about = (low, high, *ends, list(named), level, found.rejected, found.nonparametric)
    return says.finding("strength", rows["im"].iloc[0], rows["unit"].iloc[0], *about)


def headline_curves(curves: pd.DataFrame) -> Compared:
    """Curves that the first page compares: of the first measure, all outcomes counted, by one estimator."""
    first = curves["im"] == (curves["im"].iloc[0] if len(curves) else "")
    known = curves[
        first & (curves["estimator"] == "mean_probability") & curves["theta"].notna()
    ]
    return compared_curves(known)


ONE_MOTION = Finding(
    "One motion: no fragility can be given",
    "A fragility needs the motions of several earthquakes; one of them says nothing about how much they differ.",
)
"""Said in place of curves where a study has a single record."""


def recorded_found(recorded: pd.DataFrame) -> Finding:
    """Say what the motions as recorded overturn, and how much that depends on their exact strength."""
    counts = (
        recorded.groupby("configuration", sort=False)["overturned"]
        .sum()
        .astype(int)
        .to_dict()
    )
    low, high = (end(counts, key=counts.__getitem__) for end in (min, max))
    motions, fallen = (
        recorded["configuration"].value_counts().max(),
        sum(counts.values()),
    )
    near = recorded["fraction_near"].between(0, 1, inclusive="neither").sum()
    return says.finding(
        "recorded", counts, low, high, motions, fallen, len(recorded), near
    )


def amplitudes_found(tests: pd.DataFrame) -> Finding:
    """Say how many tests overturn, at which amplitudes, and what fell."""
    known, unknown = tests["amplitude_g"].dropna(), tests[tests["amplitude_g"].isna()]
    survived = unknown["upper_g"].isna()
    first, never = (list(unknown.loc[which, "test"]) for which in (~survived, survived))
    on_pedestal = tests[(tests["pedestal"] == "P") & (tests["overturned_body"] != "")]
    fell = on_pedestal["overturned_body"]
    below = int((~fell.isin(["statue"]) & (fell != on_pedestal["object"])).sum())
    return says.finding(
        "amplitudes", tests, known, first, never, below, len(on_pedestal)
    )


def objects_compared(
    means: pd.DataFrame, slenderness: Mapping[str, float]
) -> list[Finding]:
    """Say whether more slender objects overturn at lower amplitudes, where there are two of them or more."""
    rows = means[(means["by"] == "configuration") & means["mean_g"].notna()]
    parts, falling, most = [], [], 0
    for side, words in (("NP", "alone"), ("P", "on a pedestal")):
        own = rows[rows["pedestal"] == side]
        own = own.assign(slenderness=own["object"].map(slenderness))
        own = own.sort_values("slenderness", kind="stable")
        if own["slenderness"].nunique() < 2:
            continue
        each = own["configuration"] + own["mean_g"].map(" {:.3f} g".format)
        parts.append(f"{words} {wording.listed(list(each))}")
        falling.append(bool((own["mean_g"].diff().iloc[1:] < 0).all()))
        most = max(most, int(own["motions"].max()))
    if not parts:
        return []
    return [says.finding("slenderness", all(falling), most, parts)]


def mean_sentence(means: pd.DataFrame) -> str:
    """Say over which motions means are taken, and which had to be left out."""
    rows = means[means["by"] == "configuration"]
    most, of = int(rows["motions"].max()), int(rows["of"].max())
    return says.line("means", most, of)


def resurrections_found(resurrections: pd.DataFrame, tests: pd.DataFrame) -> Finding:
    """Say how often an object survives a stronger motion than one that overturned it."""
    fallen = resurrections[resurrections["first_upper"].notna()]
    wide = tests.pivot_table(index="test", columns="definition", values="amplitude_g")
    both = (
        wide.reindex(columns=["first_overturning", "always_overturning"])
        .dropna()
        .astype(float)
    )
    factor = np.exp(
        np.log(both["always_overturning"] / both["first_overturning"]).mean()
    )
    survived = int((fallen["resurrections"] > 0).sum())
    return says.finding(
        "resurrections", len(fallen), survived, float(factor), len(both)
    )


def ratio_text(row: Mapping[Any, Any]) -> str:
    """A ratio with its interval: ``1.010 [0.990, 1.030]``."""
    return wording.estimate(row["ratio"], row["lower"], row["upper"], _RATIO_DECIMALS)


says = Says(
    "rockfrag.report",
    "findings.j2",
    FRICTION=FRICTION,
    MOST_CONFIGURATIONS=6,  # so many are named with their numbers in a sentence
    RATIO_DECIMALS=_RATIO_DECIMALS,
    analyses=lambda n, total: wording.of_all(n, total, "analysis", "analyses"),
    has_interval=wording.has_interval,
    ratio_text=ratio_text,
)


def ratio_of(
    effects: pd.DataFrame,
    about: Sides = WITH_PEDESTAL,
    scope: str = "whole",
    level: str = "all",
) -> str:
    """Word the ratio of amplitudes over all pairs, or over those of a level of a scope."""
    for row in effects.to_dict("records"):
        if (row["definition"], row["scope"], row["level"]) == (
            DEFINITION,
            scope,
            level,
        ):
            limits = row["ratio"], row["lower"], row["upper"]
            return f"{about.ratio} {wording.estimate(*limits, 2)}"
    return "no pair with both amplitudes known"


def pedestal_effect(
    effects: pd.DataFrame, about: Sides = WITH_PEDESTAL
) -> list[Finding]:
    """Say by what factor what is compared changes the amplitude, over all pairs and on each floor."""
    whole = effects[effects["scope"] == "whole"]
    here = whole[whole["definition"] == DEFINITION]
    if here.empty:
        return [says.finding("no_effect", about)]
    row = here.to_dict("records")[0]
    others = whole[whole["definition"] != DEFINITION].to_dict("records")
    floors = effects[
        (effects["scope"] == "floor") & (effects["definition"] == DEFINITION)
    ]
    found = [says.finding("effect", row, about, others)]
    if len(floors) > 1:
        limits = floors[["lower", "upper"]].to_numpy(dtype=float)
        known = np.array(
            [wording.has_interval(low, high, _RATIO_DECIMALS) for low, high in limits]
        )
        clear = known & ((floors["lower"] > 1) | (floors["upper"] < 1))
        each = floors.to_dict("records")
        found.append(says.finding("floors", each, known.any(), int(clear.sum()), about))
    return found


def model_allowed(validity: pd.DataFrame) -> Finding:
    """Say how much friction rocking without sliding needs, and whether a block would have jumped."""
    demands = {
        where: part[np.isfinite(part)] for where, part in _demands(validity).items()
    }
    beyond = len(validity) - sum(map(len, demands.values()))
    lifted = int((validity["least_normal_force_n"] <= 0).sum())
    headline = friction_sentence(validity)
    return says.finding("model", headline, demands, beyond, lifted, len(validity))


def _demands(validity: pd.DataFrame) -> dict[str, pd.Series]:
    """Friction that tests need, with and without a pedestal where both were tested."""
    demand, on_pedestal = (
        validity["friction_demand"].astype(float),
        validity["pedestal"] == "P",
    )
    if on_pedestal.nunique() < 2:
        return {"": demand}
    return {"with the pedestal": demand[on_pedestal], "without": demand[~on_pedestal]}


def friction_sentence(validity: pd.DataFrame) -> str:
    """Say how many tests need more friction than dry stone has, with and without a pedestal; no full stop."""
    parts = _demands(validity).items()
    beyond = [
        (int((~(part <= FRICTION)).sum()), len(part), where) for where, part in parts
    ]
    return says.line("friction", beyond)


def sliding_found(sliding: pd.DataFrame) -> Finding:
    """Say in how many analyses bodies slid and flew, how far, and how many outcomes that changed."""
    counts = sliding[["cases", "slid", "flew", "saved", "felled"]].sum()
    where = sliding.iloc[int(sliding["largest_slip_m"].argmax())]
    return says.finding(
        "sliding", *counts, 100 * where["largest_slip_m"], where["configuration"]
    )
