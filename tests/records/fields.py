"""Samples and numbers of built records, in the fields of their formats."""

import re
from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import NDArray

# samples of a built record: no multiple of any row length, so that last rows are short
N = 43

Samples = NDArray[np.float64]


def wave(
    seed: int, scale: float = 0.3, form: str = ".5f", shift: float = 0.0
) -> Samples:
    """Return samples that fields of a form hold exactly."""
    noise = np.random.default_rng(seed).normal(size=N)
    values = scale * (np.sin(np.arange(N) * 0.2) + 0.3 * noise) + shift
    return np.array([float(format(value, form)) for value in values])


def straight_line(
    dt: float, steps: Sequence[float], start: float, slope: float
) -> tuple[Samples, Samples, Samples]:
    """Return uneven times, values on a line there, and those that interpolation to even times gives again."""
    times = np.cumsum(np.resize(steps, N)) - steps[0]
    even = np.arange(int(times[-1] / dt + 1e-9) + 1) * dt
    return times, start + slope * times[None, :], start + slope * even[None, :]


def rows(form: str, *columns: Samples) -> str:
    """Numbers of columns side by side, in rows by a Fortran format such as ``8F10.3`` or ``5E15.7``."""
    match = re.fullmatch(
        r"(?P<each>\d+)(?P<kind>I|F|ES?)(?P<width>\d+)\.?(?P<digits>\d*)(E1)?", form
    )
    assert match is not None
    width, each = int(match["width"]), int(match["each"])
    fields = [
        _field(value, form, match["kind"], match["digits"]).rjust(width)
        for value in np.column_stack(columns).ravel()
    ]
    return "\n".join("".join(fields[i : i + each]) for i in range(0, len(fields), each))


def _field(value: float, form: str, kind: str, digits: str) -> str:
    if kind in "IF":
        return f"{value:.{digits or 0}f}"
    if kind == "E":
        # Fortran's own has its first digit behind the point: -.1234567E-02
        whole, exponent = f"{abs(value):.{int(digits) - 1}E}".split("E")
        sign, power = "-" if value < 0 else "", int(exponent) + 1 if value else 0
        return f"{sign}.{whole.replace('.', '')}E{power:+03d}"
    mantissa, exponent = f"{value:.{digits}E}".split("E")
    # an exponent of one digit, so that -2.2223E-1 fills ten columns
    return (
        f"{mantissa}E{int(exponent):+d}"
        if form.endswith("E1")
        else f"{mantissa}E{exponent}"
    )


def lines(form: str, *columns: Samples) -> str:
    """Columns side by side, an instant a line."""
    return "\n".join(
        form.format(*row) for row in zip(*(c.tolist() for c in columns), strict=True)
    )


def numbers(
    count: int,
    fill: float = 0,
    places: Mapping[int, Sequence[float]] | None = None,
) -> Samples:
    """Numbers of a header, those from some places on."""
    found = np.full(count, float(fill))
    for place, values in (places or {}).items():
        found[place : place + len(values)] = values
    return found


def largest(samples: Samples) -> float:
    """The sample of the largest size, as headers state it."""
    return float(samples[np.abs(samples).argmax()])
