"""Figures of a campaign: who is right how often, fragility side by side, every test, the base from above."""

import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from scipy.stats import norm

from rockfrag import figure_style as style
from rockfrag.report.wording import label

_GREY = "#999999"
_BINS = 8


def agreement_figure(agreement: pd.DataFrame) -> Figure:
    """Draw the fraction of outcomes that the simulation and others predict right, with intervals."""
    rows = agreement.iloc[::-1].reset_index(drop=True)
    with style.one_panel(style.COLUMN_WIDTH, 0.7 + 0.24 * len(rows)) as (figure, axes):
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


def beside_figure(tests: pd.DataFrame, curves: pd.DataFrame, measure: str, label: str) -> Figure:
    """Draw measured and simulated fragility in one measure: curves, and fractions of tests in bins."""
    values = tests[measure].to_numpy()
    x = np.geomspace(values.min(), values.max(), 200)
    edges = np.unique(np.quantile(values, np.linspace(0, 1, _BINS + 1)))
    bins = np.clip(np.searchsorted(edges, values, side="right") - 1, 0, len(edges) - 2)
    with style.one_panel(style.COLUMN_WIDTH, 2.4) as (figure, axes):
        styles = (
            ("measured", "overturned", style.BLACK, "o"),
            ("rockfrag", "simulated", style.BLUE, "s"),
        )
        for who, column, colour, marker in styles:
            middle = [np.exp(np.log(values[bins == k]).mean()) for k in range(len(edges) - 1)]
            fraction = [tests[column].to_numpy()[bins == k].mean() for k in range(len(edges) - 1)]
            axes.plot(middle, fraction, ls="", marker=marker, mfc="white", color=colour)
            row = curves[curves["who"] == who].iloc[0]
            if np.isfinite(row["theta"]):
                name, line = ("measured", "-") if who == "measured" else ("simulated", "--")
                curve = norm.cdf(np.log(x / row["theta"]) / row["beta"])
                axes.plot(x, curve, color=colour, label=name, ls=line)
        style.plain_log(axes, "x")
        axes.set(xlabel=label, ylabel="Fraction of tests overturned")
        axes.legend(loc="upper left")
        return figure


def tests_figure(tests: pd.DataFrame, x: str, y: str, labels: tuple[str, str]) -> Figure:
    """Draw every test in two measures: what happened by colour, wrong predictions as crosses."""
    with style.one_panel(style.COLUMN_WIDTH, 2.8) as (figure, axes):
        for fell, colour, word in ((False, _GREY, "survived"), (True, style.ORANGE, "overturned")):
            rows = tests[(tests["overturned"] == fell) & tests["right"]]
            axes.plot(rows[x], rows[y], ls="", marker="o", ms=2.6, color=colour, label=word)
        wrong = tests[~tests["right"]]
        for fell, colour, word in (
            (True, style.RED, "overturned only in the laboratory"),
            (False, style.BLACK, "overturned only in the simulation"),
        ):
            rows = wrong[wrong["overturned"] == fell]
            axes.plot(rows[x], rows[y], ls="", marker="x", ms=4.5, color=colour, label=word)
        style.plain_log(axes, "xy")
        axes.set(xlabel=labels[0], ylabel=labels[1])
        figure.legend(loc="outside upper center", ncols=2)
        return figure


def footprint_figure(footprint: pd.DataFrame, trials: pd.DataFrame) -> Figure:
    """Draw the object from above: outline, contact polygons, centre of gravity, plausible directions."""
    with style.one_panel(style.COLUMN_WIDTH, 3.2) as (figure, axes):
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
            closed = np.vstack([corners[["x_m", "y_m"]], corners[["x_m", "y_m"]].iloc[:1]])
            tolerance = corners["contact_tolerance_mm"].iloc[0]
            label = word if not np.isfinite(tolerance) else f"contact within {tolerance:.1f} mm"
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
