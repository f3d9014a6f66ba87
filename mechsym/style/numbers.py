"""Numbers with a few significant digits."""


def significant(value: float | None, digits: int = 4) -> str:
    """A number with a few significant digits, or a dash.

    Parameters
    ----------
    value : float or None
        Number [-]

    Returns
    -------
    text : str
        Without an exponent between 1e-3 and 1e6

    Examples
    --------
    >>> significant(123456.7), significant(1.5e-7), significant(None)
    ('123500', '1.500e-07', '–')
    """
    if value is None:
        return "–"
    if value != 0 and not 1e-3 <= abs(value) < 1e6:
        return f"{value:.{digits - 1}e}"
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e" in text else text
