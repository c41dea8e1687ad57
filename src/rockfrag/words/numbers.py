"""Numbers in words: as many digits as they deserve, and never an exponent."""


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
