"""Speeds of a performance map, as written on the command line."""

from mechsym.errors import BadInput

_MOST_SPEEDS = 100_000


def parse_speeds(text: str) -> list[float]:
    """Speeds from A:B:STEP or a list with commas, in rpm.

    Parameters
    ----------
    text : str
        `500:8000:500`, `2000` or `1000,2000`

    Returns
    -------
    omega : list of float
        Crank speeds [rad/s]

    Raises
    ------
    BadInput
        Not numbers, not positive, or too many
    """
    from mechsym.quantities import parse

    parts = text.split(":")
    if len(parts) == 3:
        first, last, step = (parse(part, "-", "--speeds") for part in parts)
        if step <= 0 or last < first or (last - first) / step > _MOST_SPEEDS:
            raise BadInput(f"--speeds {text}: needs A <= B, STEP > 0 and at most {_MOST_SPEEDS} speeds")
        rpm = [first + k * step for k in range(int((last - first) / step * (1 + 1e-12) + 1e-9) + 1)]
    elif len(parts) == 1:
        rpm = [parse(part, "-", "--speeds") for part in text.split(",")]
    else:
        raise BadInput(f"--speeds {text}: write A:B:STEP in rpm, for example 500:8000:500")
    if min(rpm) <= 0:
        raise BadInput(f"--speeds {text}: speeds must be > 0 rpm")
    return [parse(f"{value!r} rpm", "rad/s") for value in rpm]
