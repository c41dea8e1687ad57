"""Amplitudes with and without pedestal: counterparts of the thesis's figures 4.1 to 4.7, and ratios.

All figures take the table of tests that the pedestal stage takes.  Tests that never overturned are
drawn as arrows from the largest amplitude survived.
"""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from rockfrag.pedestal.cluster_means import mean_effect
from rockfrag.pedestal.equivalence import MARGIN
from rockfrag.pedestal.paired_tests import (
    Pairs,
    check_tests,
    pair_tests,
    slenderness_of,
)
from rockfrag.pedestal.study import SCOPES
from rockfrag.report.figures.building import FLOOR_STYLES
from rockfrag.report.figures.style import (
    BLACK,
    BLUE,
    COLUMN_WIDTH,
    GREEN,
    OKABE_ITO,
    ORANGE,
    PAGE_WIDTH,
    RED,
    figure_style,
    new_figure,
)

GREY = "#777777"
SIDES = ("NP", "P")
SIDE_COLOUR = {"NP": ORANGE, "P": BLUE}
SIDE_MARKER = {"NP": "o", "P": "s"}
SIDE_NAME = {"NP": "without pedestal (NP)", "P": "with pedestal (P)"}
SIDE_SHIFT = {"NP": -0.13, "P": 0.13}
TOWER_MARKERS = ("o", "s", "^", "D", "v", "P")
TOWER_COLOURS = (BLUE, RED, GREEN, *OKABE_ITO)
FLOOR_NAME = {floor: name for floor, (name, _, _) in FLOOR_STYLES.items()}
LIMIT = 1.08
AMPLITUDE = "Overturning acceleration [g]"


def _levels(clean: pd.DataFrame, column: str) -> list[str]:
    """Levels in the order of the table, floors from the ground up."""
    levels = list(dict.fromkeys(clean[column]))
    if column == "floor":
        known = list(FLOOR_NAME)
        levels.sort(key=lambda name: known.index(name) if name in FLOOR_NAME else len(known))
    return levels


def _figures(tests: pd.DataFrame) -> pd.DataFrame:
    """Checked tests with ``a``, the amplitude or the largest survived one [g], and ``open``."""
    clean = check_tests(tests)
    censored = clean["censored"] == "right"
    return clean.assign(a=clean["amplitude_g"].where(~censored, clean["lower_g"]), open=censored)


def pedestal_scatter(
    tests: pd.DataFrame,
    panels: str | None = None,
    *,
    slenderness: Mapping[str, float] | None = None,
) -> Figure:
    """Amplitude with the pedestal against without it (thesis figures 4.3, 4.5, 4.7).

    Parameters
    ----------
    tests
        See :func:`rockfrag.pedestal.paired_tests.check_tests`.
    panels
        ``floor`` (4.5) or ``event`` (4.7) for a panel each; None for one panel (4.3).
    slenderness
        Height over width by object [-].
    """
    clean = _figures(tests)
    pairs = pair_tests(tests, slenderness)
    levels = [""] if panels is None else _levels(clean, panels)
    objects = _levels(clean, "object")
    upper = LIMIT * float(clean["a"].max())
    columns = {1: 1, 2: 2, 4: 2}.get(len(levels), 3)
    rows = -(-len(levels) // columns)
    width = {1: COLUMN_WIDTH, 2: 5.0, 3: PAGE_WIDTH}[columns]
    with figure_style():
        figure = new_figure(width, 0.45 + rows * (width / columns + 0.18))
        grid = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
        for axes, level in zip(grid.flat, levels, strict=False):
            part = clean if panels is None else clean[clean[panels] == level]
            _scatter_panel(axes, part, objects, upper)
            _scatter_title(axes, pairs, panels, level)
        for axes in grid.flat[len(levels) :]:
            axes.set_visible(False)
        figure.supxlabel(f"{AMPLITUDE[:-4]} without pedestal, NP [g]", fontsize=8)
        figure.supylabel(f"{AMPLITUDE[:-4]} with pedestal, P [g]", fontsize=8)
        handles = [
            Line2D([], [], ls="", marker=marker, mfc="none", mec=colour, label=object_name)
            for object_name, marker, colour in zip(
                objects, TOWER_MARKERS, TOWER_COLOURS, strict=False
            )
        ]
        grid.flat[0].legend(handles=handles, loc="lower right", handletextpad=0.2)
    return figure


def _scatter_panel(axes: Axes, part: pd.DataFrame, objects: list[str], upper: float) -> None:
    """Points of one panel on the line of equality with its band of ±10 %."""
    line = np.array([0.0, upper])
    axes.fill_between(line, line / (1 + MARGIN), line * (1 + MARGIN), color="#e9e9e9", lw=0)
    axes.plot(line, line, color=GREY, lw=0.8)
    key = ["object", "motion"]
    sides = part.groupby([*key, "pedestal"]).agg(a=("a", "mean"), open=("open", "any"))
    without = sides.xs("NP", level="pedestal").add_suffix("_np")
    both = without.join(sides.xs("P", level="pedestal").add_suffix("_p"), how="inner")
    for object_name, marker, colour in zip(objects, TOWER_MARKERS, TOWER_COLOURS, strict=False):
        own = both[both.index.get_level_values("object") == object_name]
        axes.plot(
            own["a_np"], own["a_p"], ls="", marker=marker, mfc="none", mec=colour, mew=1.0, ms=4.5
        )
        unfinished = own[own["open_np"] | own["open_p"]]
        foot = unfinished[["a_np", "a_p"]].to_numpy(dtype=float)
        length = 0.07 * upper * unfinished[["open_np", "open_p"]].to_numpy(dtype=float)
        for start, end in zip(foot, foot + length, strict=True):
            _arrow(axes, tuple(start), tuple(end), colour)
    axes.set(xlim=(0, upper), ylim=(0, upper), aspect="equal")
    axes.locator_params(nbins=5)


def _scatter_title(axes: Axes, pairs: Pairs, panels: str | None, level: str) -> None:
    """Name of the panel and the ratio of its pairs with the 95 % interval."""
    table = pairs.table if panels is None else pairs.table[pairs.table[panels] == level]
    text = "no complete pair"
    if len(table):
        effect = mean_effect(table)
        text = f"P/NP {effect.ratio:.2f}"
        if effect.units > 1:
            text += f" [{effect.ratio_lower:.2f}, {effect.ratio_upper:.2f}]"
    name = "" if panels is None else FLOOR_NAME.get(level, level) + "\n"
    # above the panel, where it hides no test
    axes.set_title(name + text, loc="left", pad=4)


def slenderness_figure(
    tests: pd.DataFrame,
    *,
    by_floor: bool = False,
    slenderness: Mapping[str, float],
) -> Figure:
    """Amplitude against slenderness without and with the pedestal (thesis figures 4.1, 4.2).

    Parameters
    ----------
    tests
        See :func:`rockfrag.pedestal.paired_tests.check_tests`.
    by_floor
        A row of panels per side and a column per floor (4.2); otherwise a panel per side (4.1).
    slenderness
        Height over width by object [-].
    """
    clean = _figures(tests)
    clean = clean.assign(x=slenderness_of(clean, slenderness))
    floors = _levels(clean, "floor")
    events = _levels(clean, "event")
    columns = floors if by_floor else list(SIDES)
    with figure_style():
        figure = new_figure(PAGE_WIDTH if by_floor else 5.2, 4.2 if by_floor else 2.7)
        grid = figure.subplots(
            2 if by_floor else 1, len(columns), sharex=True, sharey=True, squeeze=False
        )
        for number, axes in enumerate(grid.flat):
            row, column = divmod(number, len(columns))
            side = SIDES[row] if by_floor else SIDES[column]
            part = clean[clean["pedestal"] == side]
            title = SIDE_NAME[side]
            if by_floor:
                part = part[part["floor"] == floors[column]]
                title = f"{FLOOR_NAME.get(floors[column], floors[column])}, {side}"
            _against_slenderness(axes, part, events)
            axes.set_title(title, loc="left")
            axes.set_ylim(0, LIMIT * float(clean["a"].max()))
        figure.supxlabel("Slenderness H/B [-]", fontsize=8)
        figure.supylabel(AMPLITUDE, fontsize=8)
        if len(events) <= len(TOWER_MARKERS):
            handles = [
                Line2D([], [], ls="", marker=marker, mfc="none", mec=colour, label=event)
                for event, marker, colour in zip(events, TOWER_MARKERS, OKABE_ITO, strict=False)
            ]
            handles.append(Line2D([], [], color=BLACK, marker="_", ms=10, label="mean"))
            figure.legend(handles=handles, loc="outside upper center", ncols=5, handletextpad=0.3)
    return figure


def _against_slenderness(axes: Axes, part: pd.DataFrame, events: list[str]) -> None:
    """Tests by event with a little sideways shift, and the mean of those that overturned."""
    shifts = np.linspace(-0.14, 0.14, max(len(events), 2))
    few = len(events) <= len(TOWER_MARKERS)
    for number, event in enumerate(events):
        own = part[part["event"] == event]
        colour = OKABE_ITO[number % len(OKABE_ITO)] if few else GREY
        axes.plot(
            own["x"] + shifts[number],
            own["a"],
            ls="",
            marker=TOWER_MARKERS[number % len(TOWER_MARKERS)] if few else ".",
            mfc="none",
            mec=colour,
            ms=4,
        )
        _arrows_up(axes, own["x"] + shifts[number], own, colour)
    means = part[~part["open"]].groupby("x")["a"].mean()
    axes.plot(
        means.index.to_numpy(), means.to_numpy(), color=BLACK, lw=1.0, marker="_", ms=13, mew=1.8
    )
    axes.set_xticks(sorted(part["x"].unique()))


def _arrows_up(axes: Axes, x: pd.Series, rows: pd.DataFrame, colour: str) -> None:
    unfinished = rows["open"].to_numpy(dtype=bool)
    for place, a in zip(
        x.to_numpy(dtype=float)[unfinished],
        rows["a"].to_numpy(dtype=float)[unfinished],
        strict=True,
    ):
        _arrow(axes, (place, a), (place, 1.12 * a), colour)


def _arrow(axes: Axes, start: tuple[float, float], end: tuple[float, float], colour: str) -> None:
    style = {"arrowstyle": "-|>", "color": colour, "lw": 0.8, "mutation_scale": 7}
    axes.annotate("", xy=end, xytext=start, arrowprops=style)


def sides_figure(
    tests: pd.DataFrame,
    by: str,
    *,
    panels: str | None = None,
    slenderness: Mapping[str, float],
) -> Figure:
    """Amplitude without and with the pedestal side by side (thesis figures 4.4, 4.6).

    Parameters
    ----------
    tests
        See :func:`rockfrag.pedestal.paired_tests.check_tests`.
    by
        What stands on the axis: ``object`` (4.4) or ``floor`` (4.6a).
    panels
        A panel for each level of this column, such as ``object`` (4.6b).
    slenderness
        Height over width by object [-].
    """
    clean = _figures(tests)
    levels = _levels(clean, by)
    parts = [""] if panels is None else _levels(clean, panels)
    names = [_tick(by, level, slenderness) for level in levels]
    with figure_style():
        width = COLUMN_WIDTH if panels is None else PAGE_WIDTH
        figure = new_figure(width, 2.8)
        grid = figure.subplots(1, len(parts), sharey=True, squeeze=False)
        for axes, name in zip(grid[0], parts, strict=True):
            part = clean if panels is None else clean[clean[panels] == name]
            _two_sides(axes, part, by, levels)
            axes.set_xticks(range(len(levels)), names)
            axes.set_xlim(-0.5, len(levels) - 0.5)
            axes.set_ylim(0, LIMIT * float(clean["a"].max()))
            if panels is not None:
                axes.set_title(name, loc="left")
        grid[0, 0].set_ylabel(AMPLITUDE)
        handles = [
            Line2D(
                [],
                [],
                color=SIDE_COLOUR[side],
                marker=SIDE_MARKER[side],
                ls="-" if side == "P" else "--",
                label=SIDE_NAME[side] + ", line: mean",
            )
            for side in SIDES
        ]
        figure.legend(handles=handles, loc="outside upper center", ncols=2 if panels else 1)
    return figure


def _tick(by: str, level: str, slenderness: Mapping[str, float]) -> str:
    if by == "object" and level in slenderness:
        return f"{level}\nH/B = {slenderness[level]:g}"
    return FLOOR_NAME.get(level, level).replace(" ", "\n")


def _two_sides(axes: Axes, part: pd.DataFrame, by: str, levels: list[str]) -> None:
    """Tests of both sides beside each other, pairs joined, and the means of each side."""
    place = {level: float(number) for number, level in enumerate(levels)}
    key = ["object", "motion"]
    for _, pair in part.groupby(key):
        if set(pair["pedestal"]) == set(SIDES):
            heights = pair.groupby("pedestal")["a"].mean().to_dict()
            middle = place[str(pair[by].iloc[0])]
            axes.plot(
                [middle + SIDE_SHIFT[side] for side in SIDES],
                [heights[side] for side in SIDES],
                color="#cccccc",
                lw=0.5,
                zorder=1,
            )
    for side in SIDES:
        own = part[part["pedestal"] == side]
        x = own[by].map(place) + SIDE_SHIFT[side]
        axes.plot(
            x,
            own["a"],
            ls="",
            marker=SIDE_MARKER[side],
            mfc="none",
            mec=SIDE_COLOUR[side],
            ms=3.5,
            alpha=0.85,
        )
        _arrows_up(axes, x, own, SIDE_COLOUR[side])
        means = own[~own["open"]].groupby(by)["a"].mean()
        means = means.reindex([level for level in levels if level in means.index])
        axes.plot(
            [place[level] + SIDE_SHIFT[side] for level in means.index],
            means.to_numpy(),
            color=SIDE_COLOUR[side],
            ls="-" if side == "P" else "--",
            lw=1.4,
            marker=SIDE_MARKER[side],
            ms=6,
            mec=BLACK,
            mew=0.7,
            zorder=4,
        )


def forest_figure(effects: pd.DataFrame, *, cells: bool = True) -> Figure:
    """Ratio P/NP of every scope with its 95 % interval, and the ±10 % that counts as none.

    Parameters
    ----------
    effects
        Result of :func:`rockfrag.pedestal.effects_table`.
    cells
        Also the cells floor x object.
    """
    scopes = [scope for scope in SCOPES if cells or scope != "cell"]
    rows = effects[effects["scope"].isin(scopes)]
    # room for one empty line between the scopes
    place = np.arange(len(rows)) + rows["scope"].map(scopes.index).to_numpy() * 0.7
    labels = [
        _forest_label(*row) for row in rows[["scope", "level", "units", "unit"]].to_numpy().tolist()
    ]
    with figure_style():
        figure = new_figure(COLUMN_WIDTH + 1.3, 0.9 + 0.19 * float(place[-1] + 1))
        axes = figure.subplots()
        axes.axvspan(1 / (1 + MARGIN), 1 + MARGIN, color="#e9e9e9", lw=0)
        axes.axvline(1.0, color=GREY, lw=0.8)
        figures = rows[["lower", "ratio", "upper", "p_holm"]].to_numpy(dtype=float)
        for y, (lower, ratio, upper, p) in zip(place, figures, strict=True):
            axes.plot([lower, upper], [y, y], color=BLUE, lw=1.2)
            filled = BLUE if p < 0.05 else "white"
            axes.plot(ratio, y, marker="o", mec=BLUE, mfc=filled, ms=5)
        axes.set_yticks(place, labels)
        axes.invert_yaxis()
        axes.set_xscale("log")
        _ratio_ticks(axes, rows)
        axes.set_xlabel("Ratio of overturning accelerations P/NP [-]")
        axes.tick_params(axis="y", length=0)
        handles = [
            Line2D([], [], color=BLUE, marker="o", mfc=BLUE, label="differs from 1 (Holm, 5 %)"),
            Line2D([], [], color=BLUE, marker="o", mfc="white", label="may be 1"),
            Line2D([], [], color="#e9e9e9", lw=6, label="±10 %"),
        ]
        figure.legend(handles=handles, loc="outside upper center", ncols=3, handlelength=1.4)
    return figure


def _forest_label(scope: str, level: str, units: int, unit: str) -> str:
    name = "all pairs" if scope == "whole" else FLOOR_NAME.get(level, level.replace("/", ", "))
    return f"{name} ({units} {unit}{'s' if units > 1 else ''})"


def _ratio_ticks(axes: Axes, rows: pd.DataFrame) -> None:
    """Plain decimal ticks that cover what is drawn."""
    values = rows[["lower", "upper", "ratio"]].to_numpy(dtype=float)
    low, high = np.nanmin(values), np.nanmax(values)
    wide = high / low > 3
    ticks = np.array([0.25, 0.33, 0.5, 0.7, 1, 1.5, 2, 3, 4] if wide else np.arange(0.4, 2.6, 0.1))
    shown = ticks[(ticks > 0.97 * low) & (ticks < 1.03 * high)]
    if len(shown) > 8:
        shown = shown[np.isclose(np.round(shown * 5), shown * 5)]
    axes.set_xlim(0.97 * min(low, 1 / (1 + MARGIN)), 1.03 * max(high, 1 + MARGIN))
    axes.set_xticks(shown, [f"{tick:g}" for tick in np.round(shown, 2)])
    axes.minorticks_off()
