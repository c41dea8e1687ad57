"""What a reader of hazard files hands over."""

import re
from dataclasses import dataclass

from rockfrag.assess.hazard.curve import HazardCurve
from rockfrag.errors import InputError


@dataclass(frozen=True)
class Found:
    """A curve of a file and which statistic of the hazard model it is.

    Attributes
    ----------
    curve
        The curve.
    statistic
        ``mean`` or such as ``quantile-0.16``.
    """

    curve: HazardCurve
    statistic: str


def read_statistic(text: str, where: str) -> str:
    """Return the name of a statistic as ``mean`` or ``quantile-0.16``.

    Parameters
    ----------
    text
        As a file has it: ``mean``, ``quantile-0.16``, ``quantile_curve-0.5``; empty for the only curve of a file.
    where
        Where it stands, for the message.

    Raises
    ------
    InputError
        If it is another, such as one realisation of a logic tree.
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
    """Return numbers that are separated by blanks.

    Raises
    ------
    InputError
        If one is no number.
    """
    try:
        return [float(word) for word in text.split()]
    except ValueError as error:
        raise InputError(f"{where}: a level or probability is no number ({error}).") from None
