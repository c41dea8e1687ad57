"""Measured tests beside simulated ones."""

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.figure_style import COLUMN_WIDTH, one_panel
from rockfrag.report.figures import amplitudes
from rockfrag.report.page import Column, by_row, estimated, table_html
from rockfrag.report.part import FigureSpec, Part, Results, Section, figure_of, section_of
from rockfrag.report.sections.pedestal import effect_columns, shown_effects
from rockfrag.report.sections.words import says
from rockfrag.report.wording import amplitude

_TESTS = (
    Column("object", "Object"),
    Column("pedestal", "Side"),
    Column("earthquake", "Earthquake"),
    Column("floor", "Floor"),
    Column("amplitude_g", "Measured [g]", by_row(amplitude)),
    Column("simulated_g", "Simulated [g]", 3),
    Column("ratio", "Measured / simulated", 2),
)

_CURVES = (
    Column("configuration", "Configuration"),
    estimated("theta", "Median θ [g]"),
    Column("beta", "β", 3),
)


def _section(results: Results) -> Section:
    beside = results.table("measured/beside")
    ratio = np.log(beside["ratio"].dropna())
    words = says.beside(len(beside), len(ratio), np.exp(ratio.mean()), ratio.std())
    parts: list[Markup | FigureSpec] = []
    if beside["simulated_g"].notna().any():
        text = says.measured_beside_figure(words)
        parts.append(figure_of(text, "measured_beside", lambda: measured_beside(beside)))
    curves, effects = results.table("measured/fragility"), results.table("measured/effects")
    parts += [
        table_html(beside, _TESTS, "Measured tests beside simulated ones."),
        table_html(curves, _CURVES, "Fragility from the measured tests."),
    ]
    if len(effects):
        caption = "Measured effect of the pedestal."
        parts.append(table_html(shown_effects(effects), effect_columns(), caption))
    notes = results.table("measured/notes")["note"]
    return section_of(says.measured(words, notes), "measured", parts)


def measured_beside(beside: pd.DataFrame) -> Figure:
    """Draw measured against simulated amplitudes."""
    known = amplitudes.drawn_tests(beside.dropna(subset=["simulated_g"]))
    with one_panel(COLUMN_WIDTH, 3.2) as (figure, axes):
        largest = 1.15 * float(known[["a", "simulated_g"]].to_numpy(dtype=float).max())
        axes.plot([0, largest], [0, largest], color=amplitudes.GREY, lw=0.8)
        for side, name in amplitudes.SIDE_NAME.items():
            rows = known[known["pedestal"] == side]
            if rows.empty:
                continue
            marker, colour = amplitudes.SIDE_MARKER[side], amplitudes.SIDE_COLOUR[side]
            amplitudes.plot_tests(axes, rows["simulated_g"].to_numpy(float), rows, marker, colour)
            axes.plot([], [], marker, mfc="none", color=colour, label=name)
        axes.set(xlim=(0, largest), ylim=(0, largest), aspect="equal")
        axes.set(xlabel="Simulated amplitude [g]", ylabel="Measured amplitude [g]")
        axes.legend()
        return figure


MEASURED = Part(_section, asked=lambda study: study.measured_tests is not None)
