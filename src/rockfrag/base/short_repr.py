"""What results show of themselves at a prompt: a field in a line, of arrays and tables what fits there."""

import dataclasses
from collections.abc import Mapping

import numpy as np
import pandas as pd

LONGEST_LINE = 100
FEW = 6  # arrays of so many numbers are shown whole


def short_repr(result: object) -> str:
    """Return a text that fits a screen, a line for each field of a dataclass.

    Parameters
    ----------
    result : an instance of a dataclass

    Returns
    -------
    Lines of at most 100 characters.
    """
    fields = [field.name for field in dataclasses.fields(result) if field.repr]  # type: ignore[arg-type]
    lines = [f"    {name}={_shown(getattr(result, name))}" for name in fields]
    lines = [
        line if len(line) < LONGEST_LINE else f"{line[: LONGEST_LINE - 2]}…"
        for line in lines
    ]
    return f"{type(result).__name__}(\n" + ",\n".join(lines) + "\n)"


def _shown(value: object) -> str:
    """A value in few words: tables, arrays and long lists by their size."""
    if isinstance(value, pd.DataFrame):
        return f"<table of {len(value)} rows: {', '.join(map(str, value.columns))}>"
    if isinstance(value, np.ndarray) and value.size > FEW:
        return f"<array of {value.dtype}, shape {value.shape}{_range(value)}>"
    if isinstance(value, (list, tuple, Mapping)) and len(value) > FEW:
        return f"<{type(value).__name__} of {len(value)}>"
    return " ".join(repr(value).split())


def _range(values: "np.ndarray[tuple[int, ...], np.dtype[np.generic]]") -> str:
    """Return what the numbers lie between, those that are none aside."""
    if values.dtype.kind == "b":
        return f", {np.count_nonzero(values)} true"
    if values.dtype.kind not in "iuf" or np.isnan(values).all():
        return ""
    return f", from {np.nanmin(values):.4g} to {np.nanmax(values):.4g}"
