"""The answer of the USGS's hazard web services (NSHM) as JSON.

``response.hazardCurves`` is a list with ``imt`` and ``data``, of which the component ``Total`` has ``values`` with
``xs`` (levels [g]; PGV [cm/s]) and ``ys`` (annual rates of exceedance). Before 2021 ``response`` was a list with
``metadata`` (``imt``, ``xvalues``) and ``data`` (``yvalues``).
"""

import json
from typing import Any

from rockfrag.assess.hazard.curve import Found, make_curve, read_measure
from rockfrag.errors import InputError

TOTAL = "Total"


def recognise(text: str) -> bool:
    """Tell whether a text is JSON."""
    return text.lstrip().startswith(("{", "["))


def read(text: str, path: str) -> list[Found]:
    """Return the curves of all measures of an answer."""
    try:
        answer = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise InputError(f"{path}: is not whole JSON ({error}); ask the service again.") from None
    try:
        response = answer["response"]
        curves = (
            [_old(curve) for curve in response]
            if isinstance(response, list)
            else [_new(hazardcurve) for hazardcurve in response["hazardCurves"]]
        )
        if not curves:
            raise InputError(f"{path}: the answer holds no hazard curve.")
        return [
            Found(make_curve(read_measure(imt, path), _numbers(xs), _numbers(ys), path), "mean")
            for imt, xs, ys in curves
        ]
    except (KeyError, TypeError, IndexError, StopIteration, OverflowError) as error:
        raise InputError(
            f"{path}: is not an answer of the USGS hazard service with hazard curves "
            f"({type(error).__name__}: {str(error)[:80]})."
        ) from None


def _new(curve: Any) -> tuple[str, Any, Any]:
    values = _total(curve["data"])["values"]
    return str(curve["imt"]["value"]), values["xs"], values["ys"]


def _old(curve: Any) -> tuple[str, Any, Any]:
    about = curve["metadata"]
    return str(about["imt"]["value"]), about["xvalues"], _total(curve["data"])["yvalues"]


def _total(data: Any) -> Any:
    """Return the component of all sources together."""
    for component in data:
        if component["component"] == TOTAL:
            return component
    raise KeyError(TOTAL)


def _numbers(values: Any) -> list[float]:
    if not isinstance(values, list) or any(
        isinstance(value, bool) or not isinstance(value, int | float) for value in values
    ):
        raise TypeError("levels and rates are lists of numbers")
    return [float(value) for value in values]
