"""Overturning amplitudes: as recorded, of every test, and side by side by object, floor and pedestal.

In: the results of a study (tables ``as_recorded``, ``tests``, ``resurrections``, ``mean_amplitudes``, outcomes
of the IDA). Out: sections of the report with their tables and figures; amplitudes are peaks [g].

Docs: ``docs/report.md``; definitions of overturning intensity: ``docs/definitions.md``.
"""

from collections.abc import Callable, Sequence
from functools import partial
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Patch
from numpy.typing import NDArray

from rockfrag.base import figure_style as style
from rockfrag.base.files import file_name
from rockfrag.effects.paired_tests import with_counterparts
from rockfrag.report import figures, findings
from rockfrag.report.page import Column, column, table_html
from rockfrag.report.part import FigureSpec, Results, Section, chapter
from rockfrag.words.sentences import amplitude, counted, label, of_all, shortened


def _wide(
    table: pd.DataFrame, texts: list[str], about: tuple[str, ...]
) -> pd.DataFrame:
    """A row per motion, with what is known about it and a column of texts per configuration."""
    rows: dict[tuple[Any, ...], dict[str, Any]] = {}
    for row, text in zip(table.to_dict("records"), texts, strict=True):
        known = {key: row[key] for key in about}
        rows.setdefault(tuple(known.values()), known)[row["configuration"]] = text
    return pd.DataFrame(list(rows.values())).fillna("–")


def as_recorded(results: Results) -> Section:
    """What the motions do as strong as they were recorded."""
    recorded = results.table("as_recorded")
    names = recorded["configuration"].unique()
    found = findings.recorded_found(recorded)
    motions = recorded["motion"].nunique()
    caption = (
        "Largest rotation divided by the critical angle, under each motion as recorded. A dot marks an outcome "
        "that flips if the motion is scaled within ±10 %."
    )
    if motions > MOST_MOTIONS:
        caption += f" Shown are the {MOST_MOTIONS} strongest of {motions} motions; the table has all."
    figure = FigureSpec(
        "as_recorded", found.shown, caption, partial(recorded_map, recorded)
    )
    texts = [_outcome(row) for row in recorded.to_dict("records")]
    shown = _wide(recorded, texts, ("earthquake", "floor", "motion", "pga_g"))
    columns = [
        column("earthquake"),
        column("floor"),
        column("motion"),
        column("pga_g", "Peak [g]", decimals=3),
        *(Column(name, name) for name in names),
    ]
    table = table_html(
        shown, columns, "Outcome under each motion as recorded.", "as_recorded.csv"
    )
    words = (
        "Each motion shakes the objects as strongly as it was recorded, or as the building passes it on to the "
        "floor. “Sensitive” marks an outcome that flips if the motion is scaled within ±10 %."
    )
    return chapter(
        "as_recorded", "Motions as recorded", found, [words], [figure, table]
    )


def _outcome(row: dict[Any, Any]) -> str:
    """Outcome of a motion as recorded, in a word or two."""
    words = "stays"
    if row["overturned"]:
        words = "overturns"
    elif row["rocked"]:
        words = "rocks"
    elif row.get("peak_slip_m", 0.0) > 0:
        words = "slides"
    return f"{words} (sensitive)" if 0 < row["fraction_near"] < 1 else words


def amplitudes(results: Results) -> Section:
    """The amplitude of every test, and all amplitudes that overturn."""
    survived, tests = results.table("resurrections"), results.tests
    resurrections = findings.resurrections_found(survived, results.table("tests"))
    tests = tests[tests["repetition"] == tests["repetition"].min()]
    names = tests["configuration"].unique()
    columns = [column("earthquake"), column("floor"), column("motion")]
    columns += [Column(name, f"{name} [g]", numeric=True) for name in names]
    texts = [amplitude(test) for test in tests.to_dict("records")]
    shown = _wide(tests, texts, ("earthquake", "floor", "motion"))
    caption = "Overturning amplitude of every test (step protocol)."
    parts: list[Any] = [table_html(shown, columns, caption, "tests.csv")]
    for name in results.objects:
        own = results.outcomes[results.outcomes["object"] == name]
        configurations = list(dict.fromkeys(own["configuration"]))
        curves = survived[survived["configuration"].isin(configurations)]
        draw = partial(outcome_map, own, configurations)
        parts.append(_outcomes_figure(name, curves, draw))
    words = [
        resurrections.said,
        "The motion is raised in steps from rest until the body overturns. “>” stands before the largest "
        "amplitude survived by a body that never overturned, “<” before the first step where it overturned "
        "there already. These bounds enter no mean.",
        "Bars show all amplitudes that overturn. Gaps are amplitudes survived although a weaker motion "
        "overturned the body.",
    ]
    found = findings.amplitudes_found(results.tests)
    return chapter("amplitudes", "Overturning amplitudes", found, words, parts)


def _outcomes_figure(
    name: str, curves: pd.DataFrame, draw: Callable[[], Figure]
) -> FigureSpec:
    """Figure of the amplitudes that overturn one object; ``curves`` are the resurrections of its IDA curves."""
    fallen, motions = int(curves["first_upper"].count()), curves["motion"].nunique()
    counts = of_all(fallen, len(curves), "analysis", "analyses")
    caption = f"{name}: amplitudes that overturn it, by motion."
    if motions > MOST_ROWS:
        caption += (
            f" Shown are the first {MOST_ROWS} of {motions} motions; the table has all."
        )
    return FigureSpec(
        name=f"outcomes_{file_name(name)}",
        alt=f"Map of the amplitudes that overturn {name}; it overturns in {counts}.",
        caption=caption,
        draw=draw,
    )


def comparisons(results: Results) -> Section | None:
    """Objects, floors and pedestals side by side.

    Parameters
    ----------
    results : tables of the study

    Returns
    -------
    The section; None for a single test.
    """
    study, tests, means = results.study, results.tests, results.table("mean_amplitudes")
    if len(tests) < 2:
        return None
    found = findings.objects_compared(means, results.study.slenderness)
    words = findings.mean_sentence(means)
    known = means[means["mean_g"].notna()]
    whole = known[known["by"] == "configuration"].assign(
        what=lambda t: t["configuration"]
    )
    floors = known[known["by"] == "floor"].assign(
        what=lambda t: (
            t["floor"] + t["pedestal"].map({"P": ", with pedestal", "NP": ""})
        )
    )
    joins = "; thin lines join the tests of one motion with and without pedestal"
    parts: list[Any] = [
        FigureSpec(
            name="amplitudes_by_object",
            alt=f"Overturning amplitudes of {counted(len(results.objects), 'object')}. {words}",
            caption=f"Overturning amplitude of every test by object{joins if study.has_pairs else ''}.",
            draw=partial(figures.amplitudes_by, "object", tests, means),
        )
    ]
    if (of_floors := len(set(tests["floor"]))) > 1:
        figure = FigureSpec(
            name="amplitudes_by_floor",
            alt=f"Overturning amplitudes on {counted(of_floors, 'floor')}.",
            caption="Overturning amplitude of every test by floor.",
            draw=partial(figures.amplitudes_by, "floor", tests, means),
        )
        parts.append(figure)
    if study.has_pairs:
        parts.append(_paired_figure(results))
    if len(whole) > 1:
        parts.append(table_html(whole, _MEANS_COLUMNS, "Means over the same motions."))
    if len(set(floors["floor"])) > 1:
        caption = "Means over the same records and objects."
        parts.append(table_html(floors, _MEANS_COLUMNS, caption))
    title = "Objects, floors and pedestals compared"
    if not found:
        return Section("comparisons", title, words, [], parts)
    return chapter("comparisons", title, found[0], [words], parts)


_MEANS_COLUMNS = (
    column("what", "Of"),
    column("mean_g", "Geometric mean [g]", decimals=3),
    column("motions", "Tests each", decimals=0),
    column("of", "of", decimals=0),
)


def _paired_figure(results: Results) -> FigureSpec:
    """Figure of amplitudes with a pedestal, or of an arrangement, against those of the counterpart."""
    sides = findings.sides_of(results.study)
    ratio = findings.ratio_of(results.table("pedestal/effects"), sides)
    paired, _ = with_counterparts(results.tests, results.study.counterparts)
    axes = f"Amplitude {sides.first} against that {sides.second}"
    return FigureSpec(
        name="with_and_without_pedestal",
        alt=f"{axes}. {ratio}.",
        caption=f"{axes}; the grey band is ±10 %, arrows are bounds.",
        draw=partial(figures.pedestal_scatter, paired, ratio, sides),
    )


MOST_MOTIONS = 30  # more motions than this are not legible; the strongest are drawn

_SHADES = ListedColormap(["#ffffff", "#d6e6f2", "#a9cbe3", "#74abd2", "#3d86bb"])
"""Rotation from none to the critical angle; darker is nearer to overturning."""

_OVERTURNED = "#8c2d04"


def recorded_map(recorded: pd.DataFrame) -> Figure:
    """Draw a row for each motion and a column for each configuration, shaded by the largest rotation.

    Circles mark cases of which small changes of the motion overturn some and not others.
    """
    names = list(dict.fromkeys(recorded["configuration"]))
    motions = recorded.drop_duplicates("motion")
    if len(motions) > MOST_MOTIONS:
        motions = motions.nlargest(MOST_MOTIONS, "pga_g")
    rows = list(motions["motion"])
    shown = recorded[recorded["motion"].isin(rows)]
    table = _shades(shown).reindex(index=rows, columns=names).astype(float)
    sensitive = shown[shown["fraction_near"].between(0, 1, inclusive="neither")]
    with style.panels(style.WIDEST, 1.35 + 0.185 * len(rows)) as (figure, axes):
        colours = _SHADES.with_extremes(over=_OVERTURNED, bad="#ffffff")
        mesh = axes.pcolormesh(
            np.arange(len(names) + 1) - 0.5,
            np.arange(len(rows) + 1) - 0.5,
            table,
            cmap=colours,
            vmin=0,
            vmax=1,
            edgecolors="#cccccc",
            linewidth=0.4,
        )
        x = sensitive["configuration"].map(names.index)
        y = sensitive["motion"].map(rows.index)
        axes.plot(x, y, "o", ms=3.4, mfc="white", mec=style.BLACK, mew=0.7)
        axes.set_ylim(len(rows) - 0.5, -0.5)
        peaks = dict(zip(motions["motion"], motions["pga_g"], strict=True))
        axes.set_yticks(
            range(len(rows)), [f"{label(row)}, {peaks[row]:.2f} g" for row in rows]
        )
        axes.set_xticks(
            range(len(names)), [shortened(name, 16) for name in names], rotation=90
        )
        axes.tick_params(length=0, labelsize=7)
        axes.xaxis.tick_top()
        axes.spines[:].set_visible(False)
        bar = figure.colorbar(
            mesh,
            ax=axes,
            location="bottom",
            extend="max",
            extendfrac=0.12,
            aspect=28,
            pad=0.02,
        )
        bar.set_label("Rotation / critical angle (brown: overturned)")
        return figure


def _shades(recorded: pd.DataFrame) -> pd.DataFrame:
    """Largest rotation over the critical angle by motion and configuration [-]; 2 where it overturned."""
    upright = recorded["peak_rotation"].clip(0.0, 0.999)
    rotation = np.where(recorded["overturned"], 2.0, upright)
    return recorded.assign(rotation=rotation).pivot_table(
        index="motion", columns="configuration", values="rotation", aggfunc="first"
    )


MOST_ROWS = 24  # more motions than this are not legible; the first are drawn

_TICKS = (0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10)


def outcome_map(ida: pd.DataFrame, configurations: Sequence[str]) -> Figure:
    """Draw the amplitudes that overturn one object per motion, its configurations in one row of the figure."""
    rows = ida[ida["configuration"].isin(list(configurations))]
    motions = list(dict.fromkeys(rows["motion"]))[:MOST_ROWS]
    height = 0.8 / len(configurations)
    bars: dict[str, list[NDArray[np.float64]]] = {name: [] for name in configurations}
    line = {motion: len(motions) - 1 - i for i, motion in enumerate(motions)}
    for (motion, name), group in rows.groupby(["motion", "configuration"], sort=False):
        if motion in line:
            bottom = (
                line[motion]
                + 0.4
                - (list(configurations).index(str(name)) + 1) * height
            )
            bars[str(name)] += _bars(group, bottom, height)
    low, high = rows["amplitude_g"].min(), rows["amplitude_g"].max()
    with style.panels(style.WIDEST, 0.9 + 0.22 * len(motions)) as (figure, axes):
        handles = []
        for name, colour in zip(
            configurations, style.CONFIGURATION_COLOURS, strict=False
        ):
            axes.add_collection(
                PolyCollection(bars[name], facecolor=colour, linewidth=0)
            )
            handles.append(Patch(color=colour, label=f"{shortened(name)} overturns"))
        axes.set_xscale("log")
        axes.set_xlim(0.98 * low, 1.02 * high)
        ticks = [tick for tick in _TICKS if low <= tick <= high] or [
            float(f"{low:.2g}")
        ]
        axes.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
        axes.minorticks_off()
        axes.set_ylim(-0.6, len(motions) - 0.4)
        axes.set_yticks(range(len(motions)), [label(name) for name in motions[::-1]])
        axes.tick_params(axis="y", length=0, labelsize=7)
        axes.set_xlabel("Peak acceleration of the motion [g]")
        figure.legend(handles=handles, loc="outside upper center", ncols=2)
        return figure


def _bars(
    table: pd.DataFrame, bottom: float, height: float
) -> list[NDArray[np.float64]]:
    """Corners of a bar over each range of consecutive amplitudes that overturn."""
    ordered = table.sort_values("amplitude_g")
    amplitude = ordered["amplitude_g"].to_numpy(dtype=float)
    # each amplitude stands for the range up to the next one
    ratio = amplitude[-1] / amplitude[-2] if amplitude.size > 1 else 1.05
    edges = np.append(amplitude, amplitude[-1] * ratio)
    fallen = np.concatenate([[False], ordered["overturned"].to_numpy(), [False]])
    starts = edges[np.flatnonzero(~fallen[:-1] & fallen[1:])]
    ends = edges[np.flatnonzero(fallen[:-1] & ~fallen[1:])]
    low, high = np.full(starts.size, bottom), np.full(starts.size, bottom + height)
    corners = np.array([(starts, low), (ends, low), (ends, high), (starts, high)])
    return list(np.moveaxis(corners, 2, 0))
