"""Measured tests beside simulated ones: a figure and a section of the report."""

from collections.abc import Mapping

import numpy as np
import pandas as pd
from markupsafe import Markup
from matplotlib.figure import Figure

from rockfrag.report.estimate_columns import EFFECT, with_limits
from rockfrag.report.figures.style import BLUE, COLUMN_WIDTH, RED, figure_style, new_figure
from rockfrag.report.page import Column, Picture, Section, table_html
from rockfrag.thesis.ledger_html import ledger_html


def measured_section(
    tables: Mapping[str, pd.DataFrame], pictures: Mapping[str, Picture]
) -> Section:
    """Return the section on measured tests."""
    beside = tables["measured/beside"]
    ratio = np.log(beside["ratio"].dropna().to_numpy(dtype=float))
    words = f"{len(beside)} measured tests, {len(ratio)} of them with a simulated counterpart."
    if ratio.size > 1:
        words += (
            f" Measured over simulated amplitude: {np.exp(ratio.mean()):.2f} in the geometric mean, "
            f"with a scatter of {ratio.std(ddof=1):.2f} in the logarithm."
        )
    tests = (
        Column("object", "Object"),
        Column("pedestal", "Side"),
        Column("event", "Event"),
        Column("floor", "Floor"),
        Column("lower_g", "Survived [g]", 3),
        Column("upper_g", "Overturned [g]", 3),
        Column("simulated_g", "Simulated [g]", 3),
        Column("ratio", "Measured / simulated", 2),
    )
    curves = (
        Column("configuration", "Configuration"),
        *with_limits("theta", "Median θ [g]", "theta_lower", "theta_upper"),
        Column("beta", "β", 3),
    )
    parts: list[Markup | Picture] = [
        pictures["measured_beside"],
        table_html(beside, tests, "Measured tests beside simulated ones."),
        table_html(tables["measured/fragility"], curves, "Fragility from the measured tests."),
    ]
    effects = tables["measured/effects"]
    if len(effects):
        parts.append(
            table_html(effects, EFFECT, "Measured effect of the pedestal, 95 % intervals.")
        )
    if len(tables.get("measured/claims", ())):
        parts.append(ledger_html(tables["measured/claims"]))
    return Section(
        "measured",
        "Measured tests",
        [words, *tables["measured/notes"]["note"]],
        parts,
    )


def measured_beside(beside: pd.DataFrame) -> Figure:
    """Draw measured against simulated amplitudes.

    Parameters
    ----------
    beside
        As :func:`rockfrag.stages.measured_tests.beside` returns it.
    """
    known = beside.dropna(subset=["simulated_g"])
    known = known.assign(shown=known["amplitude_g"].fillna(known["lower_g"]))
    with figure_style():
        figure = new_figure(COLUMN_WIDTH, 3.2)
        axes = figure.subplots()
        largest = 1.1 * max([1.0, *known["shown"], *known["simulated_g"]])
        axes.plot([0, largest], [0, largest], color="#777777", lw=0.8)
        for side, name, colour, marker in (
            ("NP", "without pedestal", BLUE, "o"),
            ("P", "on the pedestal", RED, "s"),
        ):
            rows = known[known["pedestal"] == side]
            axes.plot(
                rows["simulated_g"], rows["shown"], marker, mfc="none", color=colour, label=name
            )
            bounds = rows[rows["censored"] == "right"]
            axes.plot(bounds["simulated_g"], bounds["shown"], "^", color=colour, ms=3)
        axes.set_xlim(0, largest)
        axes.set_ylim(0, largest)
        axes.set_aspect("equal")
        axes.set_xlabel("Simulated amplitude [g]")
        axes.set_ylabel("Measured amplitude [g]")
        axes.legend()
        return figure
