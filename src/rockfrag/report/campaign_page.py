"""Report of a campaign on a shake table: how often the simulation is right, and where it is not.

In: the tables of the stages of a campaign (``rockfrag.stages.campaign.TABLES``). Out: the page ``report.html``
with its figures. Docs: ``docs/campaigns.md``.
"""

from collections.abc import Mapping, Sequence
from functools import partial

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure
from scipy.stats import norm

from rockfrag.base import figure_style as style
from rockfrag.campaign.comparison import FEWEST_VOTERS
from rockfrag.campaign.standing import preferred_edges
from rockfrag.fragility.observations import name_and_unit
from rockfrag.fragility.vector import VectorTables
from rockfrag.report.campaign_findings import (
    better_text,
    campaign_findings,
    fragility_found,
    least_dispersed,
    percent_text,
    who_text,
)
from rockfrag.report.page import column, estimated, p_values, table_html
from rockfrag.report.part import Answer, FigureSpec, Finding, Section, chapter
from rockfrag.report.sections.curves import two_measures_section
from rockfrag.report.study_report import write_page
from rockfrag.stages.campaign import OURS, TABLES, VOTES
from rockfrag.stages.job import Job, Results
from rockfrag.study.campaign import CampaignStudy
from rockfrag.words.sentences import (
    agree,
    counted,
    label,
    listed,
    of_all,
    sentence,
)

Tables = Mapping[str, pd.DataFrame]  # of the stages of a campaign, by name


def run(job: Job[CampaignStudy]) -> Results:
    """Draw the figures of a campaign and write its page, ``report.html``, beside the tables of its stages."""
    study, tables = job.study, {name: job.table(name) for name in TABLES}
    pair = VectorTables(tables["two_measures"], tables["contours"], tables["cells"])
    both = two_measures_section(pair, study.confidence)
    # whether the motions were measured on the table, or follow from its command
    motion = "measured on" if study.motions else "commanded of"
    found, level = campaign_findings(tables), f"{100 * study.confidence:g} %"
    sections = [_agreement(tables, found[0], level), _fragility(tables, level)]
    sections += [both] if both else []
    sections += [_tests(study, tables), _object(study, tables)]
    sections.append(_conditioning(study, tables))
    tests = tables["tests"]
    specs = [
        part
        for section in sections
        for part in section.parts
        if isinstance(part, FigureSpec)
    ]
    motions = counted(tests["group"].nunique(), "input motion")
    under = f"{counted(len(tests), 'test')} under {motions}"
    answer = Answer(
        asked="How often does the simulation predict what happened on the shaking table?",
        sentences=found[:3],
        figure=next((spec for spec in specs if spec.name == "tests"), specs[0]),
        rests_on=[
            f"{under}, each simulated with the motion {motion} the table; intervals resample input motions.",
            "Unmeasured properties of the object are fitted on some motions and judged on the others.",
        ],
        could_change=[
            _near_critical(tests),
            *(f"{finding.headline}." for finding in found[3:]),
        ],
    )
    fell = int(tests["overturned"].sum())
    write_page(
        job,
        answer,
        sections,
        about={"Tests": study.tests.name},
        lead=f"{under}, {fell} of them overturned; each is simulated with the motion {motion} the table.",
        basis="measured",
    )
    yield from ()


def _near_critical(tests: pd.DataFrame) -> str:
    """Sentence on the tests about which plausible arrangements disagree."""
    near, total = int(tests["near_critical"].sum()), len(tests)
    return (
        f"{sentence(of_all(near, total, 'test'))} {agree(near, total, 'is', 'are')} near-critical: plausible "
        "ways to set up the object disagree about the outcome in more than one of ten."
    )


def _with_percents(table: pd.DataFrame) -> pd.DataFrame:
    """Add the fraction of outcomes that are right in words."""
    return table.assign(percent=[percent_text(row) for row in table.to_dict("records")])


def _agreement(tables: Tables, found: Finding, level: str) -> Section:
    """How often each prediction is right, beside the simulation."""
    named = _with_percents(tables["agreement"])
    lead = [better_text(row) for row in named.to_dict("records")]
    named = named.assign(who=[who_text(name) for name in named["who"]], lead=lead)
    best = max(named.to_dict("records"), key=lambda row: float(row["right"]))
    figure = FigureSpec(
        name="agreement",
        alt=f"{sentence(best['who'])} is right most often, in {percent_text(best)} of the tests.",
        caption=(
            f"Outcomes predicted right, with {level} intervals over motions. Filled dots are judged on motions "
            "that were not used for fitting, open ones are as given."
        ),
        draw=lambda: agreement_figure(named),
    )
    caption = "Outcomes predicted, and the difference on the same tests."
    agreement = table_html(named, _AGREEMENT_COLUMNS, caption)
    # empty where the laboratory noted nothing of it
    caption = "Whether the object rocked at all, simulated and noted."
    rocking = table_html(_with_percents(tables["rocking"]), _ROCKING_COLUMNS, caption)
    words = (
        "Unmeasured properties, and thresholds, are fitted on some motions and judged on the others. Other "
        "programs are as their authors tuned them, on these tests."
    )
    title = "How often each prediction is right"
    return chapter("agreement", title, found, [words], [figure, agreement, rocking])


_AGREEMENT_COLUMNS = (
    column("who", "Predicted by"),
    column("tests", decimals=0),
    column("percent", "Right", numeric=True),
    column("false_alarms", decimals=1),
    column("missed", decimals=1),
    column("lead", "Simulation better by [percentage points]", numeric=True),
    p_values("p", "p"),
    column("judged"),
)
_ROCKING_COLUMNS = (
    column("percent", "Right", numeric=True),
    column("false_alarms", "Rocked in the simulation only", decimals=1),
    column("missed", "Rocked in the laboratory only", decimals=1),
)


def _conditioning(study: CampaignStudy, tables: Tables) -> Section:
    """What filters and baselines of the motions do to the predictions."""
    steps = [" ".join(map(str, step.values())) for step in study.conditioning]
    columns = [
        column("conditioning"),
        column("trials", decimals=0),
        column("percent", "Right", numeric=True),
        column("false_alarms", decimals=1),
        column("missed", decimals=1),
    ]
    caption = "Outcomes predicted right, by conditioning."
    table = table_html(_with_percents(tables["conditioning"]), columns, caption)
    return Section(
        "conditioning",
        "Effect of conditioning the motions",
        f"Conditioning of the motions: {listed(steps) or 'none'}.",
        ["Alternatives were tried with a part of the trials."],
        [table],
    )


def _fragility(tables: Tables, level: str) -> Section:
    """Curves of measured and simulated outcomes."""
    fragility, tests = tables["fragility"], tables["tests"]
    outcomes = {
        "measured": "measured",
        OURS: "simulated, majority of votes",
        VOTES: "simulated, votes",
    }
    shown = fragility.assign(
        measure=[_with_unit(name) for name in fragility["measure"]],
        who=fragility["who"].map(outcomes),
    )
    measure = least_dispersed(fragility)
    name = name_and_unit(measure)[0]
    found = fragility_found(fragility)
    own = fragility[fragility["measure"] == measure]
    figure = FigureSpec(
        name="fragility_beside",
        alt=f"{found[0].headline if found else 'No curve rises'}.",
        caption=(
            f"Measured (dots, line) and simulated (squares, dashes) fragility in {name}; points are fractions in "
            "bins of equally many tests."
        ),
        draw=partial(beside_figure, tests, own, measure, _with_unit(measure)),
    )
    columns = [
        column("measure"),
        column("who", "Outcomes"),
        estimated("theta", "Median θ", 3),
        estimated("beta", "Dispersion β", 2),
        estimated("theta_ratio", "θ over measured", 2),
        estimated("beta_ratio", "β over measured", 2),
    ]
    table = table_html(shown, columns, "Curves of measured and of simulated outcomes.")
    words = f"Lognormal curves with {level} intervals from resampled motions; the ratio is taken in each resample."
    title = "Fragility, measured and simulated"
    parts: list[Markup | FigureSpec] = [figure, table]
    if not found:
        return Section("fragility", title, "No curve rises.", [words], parts)
    return chapter("fragility", title, found[0], [words], parts)


def _with_unit(measure: str) -> str:
    """Name of a column of a measure with its unit in brackets."""
    name, unit = name_and_unit(measure)
    return f"{name} [{unit}]"


def _regions_table(regions: pd.DataFrame, names: Sequence[str]) -> Markup:
    """Table of the tests by thirds of the measures, with how many are predicted as they happened."""
    shown = regions[regions["tests"] > 0].assign(right=100 * regions["right"])
    for name in names:
        ends = zip(shown[f"{name}_from"], shown[f"{name}_to"], strict=True)
        shown[name] = [f"{low:.3g} to {high:.3g}" for low, high in ends]
    columns = [
        *(column(name, _with_unit(name), numeric=True) for name in names),
        column("tests", decimals=0),
        column("overturned", decimals=0),
        column("simulated", decimals=0),
        column("right", "Right [%]", decimals=0),
    ]
    return table_html(shown, columns, "Tests by thirds of two measures.")


def _wrong_table(tests: pd.DataFrame, measures: Sequence[str]) -> Markup:
    """Table of the tests that are predicted otherwise than they happened."""
    wrong = tests[~tests["right"]].assign(votes=lambda t: 100 * t["votes_to_overturn"])
    columns = [
        column("test"),
        column("group", "Input motion"),
        *(column(name, _with_unit(name), decimals=3) for name in measures),
        column("overturned"),
        column("votes", "Votes to overturn [%]", decimals=0),
        column("near_critical", "Near-critical"),
    ]
    return table_html(wrong, columns, "Tests predicted wrong.")


def _tests(study: CampaignStudy, tables: Tables) -> Section:
    """All tests, with the range of each motion's scales that overturns."""
    tests, regions = tables["tests"], tables["regions"]
    names = [
        name.removesuffix("_from")
        for name in map(str, regions)
        if name.endswith("_from")
    ]
    message = (
        f"{int(tests['right'].sum())} of {len(tests)} tests are predicted as they happened, each by the majority "
        "of all repeats."
    )
    parts: list[Markup | FigureSpec] = []
    if len(names) == 2:
        x, y = names
        draw = partial(tests_figure, tests, x, y, (_with_unit(x), _with_unit(y)))
        caption = (
            "Every test by the intensity of its motion; crosses are wrong predictions."
        )
        parts.append(FigureSpec("tests", message, caption, draw))
    parts.append(_regions_table(regions, names))
    parts.append(_wrong_table(tests, list(study.measures or names)))
    words = (
        "Votes are the fraction of plausible ways to set up the object under which it overturns. Here each test "
        "has one answer, by the votes of all repeats together; the fraction on the first page is a mean over "
        "repeats, so that its counts may differ by a test or two."
    )
    return Section("tests", "Where the simulation is right", message, [words], parts)


_PROPERTIES = {
    "direction_deg": "Direction of shaking [°]",
    "contact_tolerance_mm": "Contact tolerance [mm]",
    "edge_retreat_mm": "Retreat of the edges [mm]",
    "restitution": "Restitution [-]",
    "friction": "Coefficient of friction [-]",
    "left_m": "Left edge to the centre of gravity [m]",
    "right_m": "Right edge to the centre of gravity [m]",
    "alpha_deg": "Smaller critical angle [°]",
}
"""Unmeasured properties of an object by their columns in the table ``trials``."""


def _object(study: CampaignStudy, tables: Tables) -> Section:
    """How the object stands: what trials leave plausible, and its contact."""
    trials, contact = tables["trials"], tables["contact"]
    likely = trials[trials["plausible"]]
    parts: list[Markup | FigureSpec] = []
    if not tables["footprint"].empty:
        width = 100 * (likely["left_m"] + likely["right_m"])
        figure = FigureSpec(
            name="footprint",
            alt=f"Plausible bases are {width.min():.1f} to {width.max():.1f} cm wide.",
            caption=(
                "The object from above: outline, contact polygons for plausible tolerances, centre of gravity, "
                "and plausible directions of shaking."
            ),
            draw=partial(footprint_figure, tables["footprint"], trials),
        )
        parts.append(figure)
    rows = [
        {
            "property": words,
            "tried": _range(trials[name]),
            "plausible": _range(likely[name]),
            "median": f"{likely[name].median():.3g}",
        }
        for name, words in _PROPERTIES.items()
        if name in trials
    ]
    caption = (
        "Unmeasured properties: ranges tried, and ranges that agree with the tests."
    )
    parts.append(table_html(pd.DataFrame(rows), _PROPERTY_COLUMNS, caption))
    in_percent = {
        name: 100 * contact[name] for name in ("width_m", "overturned", "right")
    }
    caption = "Smallest critical angle by contact tolerance; the object cannot stand where it is negative."
    table = table_html(contact.assign(**in_percent), _CONTACT_COLUMNS, caption)
    message = f"{len(likely)} of {len(trials)} trials are plausible."
    words = _object_words(study, trials, likely)
    return Section("object", "How the object stood", message, words, [*parts, table])


_PROPERTY_COLUMNS = (
    column("property"),
    column("tried", "Range tried", numeric=True),
    column("plausible", "Plausible range", numeric=True),
    column("median", "Median of the plausible", numeric=True),
)
_CONTACT_COLUMNS = (
    column("contact_tolerance_mm", decimals=2),
    column("worst_direction_deg", decimals=0),
    column("alpha_deg", "Critical angle [°]", decimals=1),
    column("alpha_lower_deg", "5 % of scans", decimals=1),
    column("alpha_upper_deg", "95 % of scans", decimals=1),
    column("trials", "Trials near it", decimals=0),
    column("width_m", "Their base [cm]", decimals=1),
    column("overturned", "Overturn in [% of tests]", decimals=0),
    column("right", "Right, in sample [%]", decimals=0),
)


def _object_words(
    study: CampaignStudy, trials: pd.DataFrame, likely: pd.DataFrame
) -> list[str]:
    """Paragraphs on the trials that are plausible, and on what is left open."""
    words = [
        "A trial is plausible if its predictions are as right as the best within two standard errors. It is "
        "chosen on all tests and therefore judges nothing."
    ]
    if blocks := len(study.object.get("pedestal", ())):
        words.append(
            f"The object stands on {counted(blocks, 'block')}; retreat and friction are the same at every "
            "contact, and the distances of the edges and the critical angle are those of the object alone."
        )
    if len(likely) < FEWEST_VOTERS:
        words.append(
            f"Fewer than {FEWEST_VOTERS} trials vote, so that chance decides near-critical tests: raise the "
            "number of trials."
        )
    # ranges that end where the tests would have them go on
    edges = [
        f"{_PROPERTIES[name].split(' [')[0].lower()} ({edge})"
        for name, edge in preferred_edges(trials, likely.index, study.unknowns).items()
    ]
    if edges:
        words.append(
            f"Plausible trials lie at an end of the range of: {listed(edges)}. Widen the range there: what lies "
            "beyond may be as plausible."
        )
    return words


def _range(values: pd.Series) -> str:
    return f"{values.min():.3g} to {values.max():.3g}"


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
    """Draw measured and simulated fragility in one measure: curves, and fractions of tests in bins.

    Parameters
    ----------
    tests : a row a test, with the ``measure``, and whether it was measured and simulated to overturn
    curves : lognormal curves, rows with ``who``, ``theta`` and ``beta``
    measure : column of the tests
    label : of the axis of the measure, with its unit
    """
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
    """Draw every test in two measures: what happened by colour, wrong predictions as crosses.

    Parameters
    ----------
    tests : a row a test, with both measures, ``overturned`` in the laboratory, and whether that was ``right``
    x, y : columns of the measures
    labels : of the axes
    """
    with style.panels(style.COLUMN_WIDTH, 2.8) as (figure, axes):
        for right, fell, colour, word in (
            (True, False, style.GUIDE, "survived"),
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
            "outline": (style.GUIDE, "-", "outline"),
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
            axes.plot(ends[:, 0], ends[:, 1], color=style.BLUE, lw=0.8, label=words)
        axes.set(aspect="equal", xlabel="x [m]", ylabel="y [m]")
        figure.legend(loc="outside upper center", ncols=2)
        return figure
