"""Numbers in words: as many digits as they deserve, never an exponent, and on one line with their units."""

import re

UNITS = (
    *("%", "m", "cm", "mm", "km", "s", "g", "kg", "kg/m³", "N", "kN", "kPa", "MPa"),
    *("N/m", "kN/m", "m/s", "cm/s", "m/s²", "Hz", "rad", "bit"),
)
"""Units that stay on a line with the number before them."""

_BEFORE_UNIT = re.compile(rf"(?<=\d) (?=(?:{'|'.join(UNITS)})(?![\w/]))")


def kept_together(text: str) -> str:
    """Return a text whose lines break nowhere between a number and its unit.

    Parameters
    ----------
    text : in which a space stands between them

    Returns
    -------
    The text with a space there that does not break.
    """
    return _BEFORE_UNIT.sub("\u00a0", text)


def significant(value: float, digits: int) -> str:
    """A number to so many digits, without zeros at its end: ``0.25``, ``1230``.

    Halves go to the even digit, as in the page.

    Parameters
    ----------
    value, digits : the number, and to how many digits

    Returns
    -------
    The text.
    """
    if value == 0:
        return "0"
    mantissa, exponent = f"{value:.{digits - 1}e}".split("e")
    decimals = max(0, digits - 1 - int(exponent))
    text = f"{float(f'{mantissa}e{exponent}'):.{decimals}f}"
    return text.rstrip("0").rstrip(".") if "." in text else text


def limit_percent(fraction: float) -> str:
    """A limit of a fraction [-] in per cent, without the sign.

    Whole numbers from 10 on, two digits from 1 on, one below, and one decimal where it is nearly 100.
    """
    value = 100 * fraction
    if value < 5e-4:
        return "0"
    if value >= 99.95:
        return "100"
    if value >= 99.5:
        return f"{value:.1f}"
    if value >= 10:
        return f"{value:.0f}"
    return significant(value, 2 if value >= 1 else 1)


def whole_number(value: float) -> str:
    """A number to the next whole one, with a real minus sign; halves go to the even one."""
    return str(round(value)).replace("-", "−")
