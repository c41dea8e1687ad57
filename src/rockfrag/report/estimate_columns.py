"""Columns of tables of estimates with their limits, the effect of the pedestal among them."""

from rockfrag.report.page import Column


def with_limits(name: str, title: str, lower: str, upper: str) -> tuple[Column, Column, Column]:
    """Columns of an estimate and of its two limits, by their names in the data."""
    return Column(name, title, 3), Column(lower, "from", 3), Column(upper, "to", 3)


PAIRS = Column("pairs", "Pairs", 0)
P_HOLM = Column("p_holm", "p (Holm)", 3)
EFFECT = (
    Column("scope", "Scope"),
    Column("level", "Level"),
    PAIRS,
    *with_limits("ratio", "P/NP", "lower", "upper"),
    P_HOLM,
)
"""What is shown of :func:`rockfrag.pedestal.study.effects_table`."""
