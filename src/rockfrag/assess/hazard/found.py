"""What a reader of hazard files hands over."""

import re
from dataclasses import dataclass

from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.errors import InputError


@dataclass(frozen=True)
class Found:
    """A curve of a file and which statistic of the hazard model it is."""

    curve: HazardCurve  # The curve
    statistic: str  # ``mean`` or such as ``quantile-0.16``


def read_statistic(text: str, where: str) -> str:
    """Return the name of a statistic as ``mean`` or ``quantile-0.16``; refuse a single branch of a logic tree.

    It may stand there as ``quantile_curve-0.5``, or be empty for the only curve of a file.
    """
    if text in ("", "mean"):
        return "mean"
    quantile = re.fullmatch(r"quantile\D*?(0?\.\d+)", text)
    if quantile:
        return f"quantile-{float(quantile[1]):g}"
    raise InputError(
        f"{where}: the curve is of the kind {text[:40]!r}; give the mean and the quantiles of the hazard model, "
        "not single branches or deviations."
    )


def read_numbers(text: str, where: str) -> list[float]:
    """Return numbers that are separated by blanks."""
    try:
        return [float(word) for word in text.split()]
    except ValueError as error:
        raise InputError(f"{where}: a level or probability is no number ({error}).") from None
