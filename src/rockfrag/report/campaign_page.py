"""The report of a campaign on a shake table: how often the simulation is right, and where it is not."""

import math
from functools import partial

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure
from scipy.stats import norm

from rockfrag.base import figure_style as style
from rockfrag.campaign.comparison import FEWEST_VOTERS, REPEATS
from rockfrag.campaign.standing import preferred_edges
from rockfrag.fragility.observations import name_and_unit
from rockfrag.fragility.vector import VectorTables
from rockfrag.report.page import Row
from rockfrag.report.part import Answer, FigureSpec, Finding, Says, Section
from rockfrag.report.sections.curves import two_measures_section
from rockfrag.report.study_report import write_page
from rockfrag.stages.campaign import IN_PLANE, OURS, TABLES, VOTES
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import CampaignStudy
from rockfrag.words.sentences import estimate, estimates, label, number, probability


def run(job: Job[CampaignStudy]) -> Results:
    """Draw the figures of a campaign and write its page, ``report.html``, beside the tables of its stages."""
    study, tables = job.study, {name: job.table(name) for name in TABLES}
    pair = VectorTables(tables["two_measures"], tables["contours"], tables["cells"])
    both = two_measures_section(pair, study.confidence)
    # whether the motions were measured on the table, or follow from what it was told
    motion = "commanded of" if study.pulse_cycles else "measured on"
    found, level = _findings(tables), f"{100 * study.confidence:g} %"
    sections = [_agreement(tables, found[0], level), _fragility(tables, level)]
    sections += [both] if both else []
    sections += [_tests(study, tables), _object(study, tables)]
    steps = [" ".join(map(str, step.values())) for step in study.conditioning]
    table = says.table("conditioning", _with_percents(tables["conditioning"]))
    sections.append(says.section("conditioning", [table], steps))
    tests = tables["tests"]
    near = says("near_critical", int(tests["near_critical"].sum()), len(tests))
    specs = [
        part
        for section in sections
        for part in section.parts
        if isinstance(part, FigureSpec)
    ]
    answer = Answer(
        asked="How often does the simulation predict what happened on the shaking table?",
        sentences=found[:3],
        figure=next((spec for spec in specs if spec.name == "tests"), specs[0]),
        rests_on=says("rests_on", tests, motion),
        could_change=[*near, *(finding.headline + "." for finding in found[3:])],
    )
    lead, about = says.line("lead", tests, motion), {"Tests": study.tests.name}
    write_page(job, answer, sections, about, lead=lead, basis="measured")
    yield from ()


def _percent(row: Row) -> str:
    return (
        estimate(100 * row["right"], 100 * row["lower"], 100 * row["upper"], 1) + " %"
    )


def _better(row: Row) -> str:
    """By how many percentage points the simulation is better, with limits; a dash for itself."""
    limits = (number(100 * row[f"better{end}"], 1) for end in ("", "_lower", "_upper"))
    return "–" if math.isnan(row["better"]) else "{} [{}, {}]".format(*limits)


LEVEL = 0.05  # a difference between programs is stated below this adjusted p value [-]


def _p(value: float) -> str:
    text = probability(value)
    return text if text.startswith("<") else f"= {text}"


says = Says(
    "rockfrag.report",
    "campaign_page.j2",
    **{"better": _better, "estimate": estimate, "p": _p, "percent": _percent},
    **{"FEWEST_VOTERS": FEWEST_VOTERS, "LEVEL": LEVEL},
)


def _who(name: str) -> str:
    """Who predicted the outcomes, in words: thresholds by their measure, codes by their name."""
    if name in (OURS, IN_PLANE):
        return "simulation" + name.removeprefix(OURS)
    for start in ("threshold on ", "probit on "):
        if name.startswith(start):
            measures = name.removeprefix(start).split(" and ")
            return start + " and ".join(
                name_and_unit(measure)[0] for measure in measures
            )
    return name


def _findings(tables: dict[str, pd.DataFrame]) -> list[Finding]:
    ours, *others = tables["agreement"].to_dict("records")
    found = [says.finding("predicted", ours)]
    # whether three dimensions predict better than one plane
    found += [
        says.finding("beside_plane", ours, row)
        for row in others
        if row["who"] == IN_PLANE
    ]
    # what is read off the tests themselves is the ceiling of all models, not one of them
    rivals = [row for row in others if row["who"] not in (REPEATS, IN_PLANE)]
    if rivals:
        best = max(rivals, key=lambda row: float(row["right"]))
        found.append(
            says.finding("beside_rivals", best, _who(best["who"]), len(rivals))
        )
    found += _fragility_found(tables["fragility"])
    tests = tables["tests"]
    near, wrong = tests["near_critical"], ~tests["right"]
    if wrong.any():
        counts = (
            int((wrong & near).sum()),
            int(wrong.sum()),
            int(near.sum()),
            len(tests),
        )
        found.append(says.finding("wrong", *counts))
    return found


def _fragility_found(fragility: pd.DataFrame) -> list[Finding]:
    measure = _ordering(fragility)
    rows = fragility[
        (fragility["measure"] == measure) & fragility["theta_ratio"].notna()
    ]
    if rows.empty:
        return []
    # simulated over measured median and dispersion, with limits
    texts = zip(
        *(estimates(rows, f"{key}_ratio", 2) for key in ("theta", "beta")), strict=True
    )
    found = dict(zip(rows["who"], texts, strict=True))
    return [
        says.finding(
            "fragility_found", name_and_unit(measure)[0], found[OURS], found[VOTES]
        )
    ]


def _ordering(fragility: pd.DataFrame) -> str:
    """Return the measure in which the measured curve has the least dispersion."""
    measured = fragility[fragility["who"] == "measured"]
    return str(measured.set_index("measure")["beta"].fillna(math.inf).idxmin())


def _with_percents(table: pd.DataFrame) -> pd.DataFrame:
    """Add the fraction of outcomes that are right in words."""
    return table.assign(percent=[_percent(row) for row in table.to_dict("records")])


def _agreement(tables: dict[str, pd.DataFrame], found: Finding, level: str) -> Section:
    named = _with_percents(tables["agreement"])
    lead = [_better(row) for row in named.to_dict("records")]
    named = named.assign(who=[_who(name) for name in named["who"]], lead=lead)
    best = max(named.to_dict("records"), key=lambda row: float(row["right"]))
    parts: list[Markup | FigureSpec] = [
        says.figure(
            "agreement", lambda: agreement_figure(named), best, best["who"], level
        ),
        says.table("agreement", named),
        # empty where the laboratory noted nothing of it
        says.table("rocking", _with_percents(tables["rocking"])),
    ]
    return says.section("agreement", parts, found)


def _fragility(tables: dict[str, pd.DataFrame], level: str) -> Section:
    fragility, tests = tables["fragility"], tables["tests"]
    shown = fragility.assign(
        measure=[
            "{} [{}]".format(*name_and_unit(name)) for name in fragility["measure"]
        ],
        who=fragility["who"].map(
            {"measured": "measured"} | says.pairs("outcomes", OURS, VOTES)
        ),
    )
    measure = _ordering(fragility)
    name, unit = name_and_unit(measure)
    found = _fragility_found(fragility)
    own = fragility[fragility["measure"] == measure]
    draw = partial(beside_figure, tests, own, measure, f"{name} [{unit}]")
    figure = says.figure("fragility_beside", draw, found, name)
    return says.section(
        "fragility", [figure, says.table("fragility", shown)], found, level
    )


def _tests(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    tests, regions = tables["tests"], tables["regions"]
    names = [
        name.removesuffix("_from")
        for name in map(str, regions)
        if name.endswith("_from")
    ]
    listed = study.measures or names
    labels = {
        name: "{} [{}]".format(*name_and_unit(name)) for name in (*names, *listed)
    }
    shown = regions[regions["tests"] > 0].assign(right=100 * regions["right"])
    for name in names:
        ends = zip(shown[f"{name}_from"], shown[f"{name}_to"], strict=True)
        shown[name] = [f"{low:.3g} to {high:.3g}" for low, high in ends]
    wrong = tests[~tests["right"]].assign(votes=lambda t: 100 * t["votes_to_overturn"])
    parts: list[Markup | FigureSpec] = []
    if len(names) == 2:
        x, y = names
        draw = partial(tests_figure, tests, x, y, (labels[x], labels[y]))
        parts.append(says.figure("tests", draw, tests))
    parts.append(says.table("regions", shown, {name: labels[name] for name in names}))
    parts.append(says.table("wrong", wrong, {name: labels[name] for name in listed}))
    return says.section("tests", parts, tests)


def _object(study: CampaignStudy, tables: dict[str, pd.DataFrame]) -> Section:
    trials, contact, footprint = (
        tables["trials"],
        tables["contact"],
        tables["footprint"],
    )
    likely = trials[trials["plausible"]]
    parts: list[Markup | FigureSpec] = []
    if not footprint.empty:
        draw = partial(footprint_figure, footprint, trials)
        parts.append(
            says.figure("footprint", draw, 100 * (likely["left_m"] + likely["right_m"]))
        )
    titles = says.pairs("properties")
    rows = [
        (
            words,
            _range(trials[name]),
            _range(likely[name]),
            f"{likely[name].median():.3g}",
        )
        for name, words in titles.items()
        if name in trials
    ]
    properties = pd.DataFrame(
        rows, columns=["property", "tried", "plausible", "median"]
    )
    parts.append(says.table("properties", properties))
    in_percent = {
        name: 100 * contact[name] for name in ("width_m", "overturned", "right")
    }
    parts.append(says.table("contact", contact.assign(**in_percent)))
    # ranges that end where the tests would have them go on
    edges = [
        f"{titles[name].split(' [')[0].lower()} ({edge})"
        for name, edge in preferred_edges(trials, likely.index, study.unknowns).items()
    ]
    blocks = len(study.object.get("pedestal", ()))
    return says.section("object", parts, blocks, len(likely), len(trials), edges)


def _range(values: pd.Series) -> str:
    return f"{values.min():.3g} to {values.max():.3g}"


_GREY = "#999999"
_BINS = 8


def agreement_figure(agreement: pd.DataFrame) -> Figure:
    """Draw the fraction of outcomes that the simulation and others predict right, with intervals."""
    rows = agreement.iloc[::-1].reset_index(drop=True)
    with style.panels(style.COLUMN_WIDTH, 0.7 + 0.24 * len(rows)) as (figure, axes):
        for place, row in enumerate(rows.to_dict("records")):
            colour = style.BLUE if place == len(rows) - 1 else style.BLACK
            filled = row["judged"] == "by other motions"
            ends = [100 * row["lower"], 100 * row["upper"]]
            axes.plot(ends, [place, place], color=colour, lw=1.2)
            inside = colour if filled else "white"
            axes.plot(100 * row["right"], place, "o", color=colour, mfc=inside)
        axes.set_yticks(range(len(rows)), [label(name) for name in rows["who"]])
        axes.set_xlabel("Outcomes right [%]")
        axes.grid(axis="x")
        return figure


def beside_figure(
    tests: pd.DataFrame, curves: pd.DataFrame, measure: str, label: str
) -> Figure:
    """Draw measured and simulated fragility in one measure: curves, and fractions of tests in bins."""
    values = tests[measure].to_numpy()
    x = np.geomspace(values.min(), values.max(), 200)
    edges = np.unique(np.quantile(values, np.linspace(0, 1, _BINS + 1)))
    bins = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
    with style.panels(style.COLUMN_WIDTH, 2.4) as (figure, axes):
        middle = [
            np.exp(np.log(values[bins == k]).mean()) for k in range(len(edges) - 1)
        ]
        for who, column, name, colour, marker, line in (
            ("measured", "overturned", "measured", style.BLACK, "o", "-"),
            (OURS, "simulated", "simulated", style.BLUE, "s", "--"),
        ):
            fraction = [
                tests[column].to_numpy()[bins == k].mean()
                for k in range(len(edges) - 1)
            ]
            axes.plot(middle, fraction, ls="", marker=marker, mfc="white", color=colour)
            row = curves[curves["who"] == who].iloc[0]
            if np.isfinite(row["theta"]):
                curve = norm.cdf(np.log(x / row["theta"]) / row["beta"])
                axes.plot(x, curve, color=colour, label=name, ls=line)
        style.plain_log(axes, "x")
        axes.set(xlabel=label, ylabel="Fraction of tests overturned")
        axes.legend(loc="upper left")
        return figure


def tests_figure(
    tests: pd.DataFrame, x: str, y: str, labels: tuple[str, str]
) -> Figure:
    """Draw every test in two measures: what happened by colour, wrong predictions as crosses."""
    with style.panels(style.COLUMN_WIDTH, 2.8) as (figure, axes):
        for right, fell, colour, word in (
            (True, False, _GREY, "survived"),
            (True, True, style.ORANGE, "overturned"),
            (False, True, style.RED, "overturned only in the laboratory"),
            (False, False, style.BLACK, "overturned only in the simulation"),
        ):
            rows = tests[(tests["overturned"] == fell) & (tests["right"] == right)]
            marker, size = ("o", 2.6) if right else ("x", 4.5)
            axes.plot(
                rows[x],
                rows[y],
                ls="",
                marker=marker,
                ms=size,
                color=colour,
                label=word,
            )
        style.plain_log(axes, "xy")
        axes.set(xlabel=labels[0], ylabel=labels[1])
        figure.legend(loc="outside upper center", ncols=2)
        return figure


def footprint_figure(footprint: pd.DataFrame, trials: pd.DataFrame) -> Figure:
    """Draw the object from above: outline, contact polygons, centre of gravity, plausible directions."""
    with style.panels(style.COLUMN_WIDTH, 3.2) as (figure, axes):
        styles = {
            "outline": (_GREY, "-", "outline"),
            "contact, low": (style.GREEN, ":", None),
            "contact": (style.GREEN, "-", "contact polygon"),
            "contact, high": (style.GREEN, "--", None),
        }
        for what, (colour, line, word) in styles.items():
            corners = footprint[footprint["what"] == what]
            if corners.empty:
                continue
            closed = corners[["x_m", "y_m"]].to_numpy()[[*range(len(corners)), 0]]
            tolerance = corners["contact_tolerance_mm"].iloc[0]
            label = (
                word
                if not np.isfinite(tolerance)
                else f"contact within {tolerance:.1f} mm"
            )
            axes.plot(closed[:, 0], closed[:, 1], ls=line, color=colour, label=label)
        axes.plot(0, 0, "+", color=style.BLACK, ms=9, label="centre of gravity")
        reach = float(footprint[["x_m", "y_m"]].abs().to_numpy().max())
        likely = np.radians(trials.loc[trials["plausible"], "direction_deg"].to_numpy())
        for number, angle in enumerate(likely[:60]):
            ends = reach * np.array([[1.02], [1.12]]) * [np.cos(angle), np.sin(angle)]
            words = None if number else "plausible direction"
            axes.plot(*ends.T, color=style.BLUE, lw=0.8, label=words)
        axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
        figure.legend(loc="outside upper center", ncols=2)
        return figure
