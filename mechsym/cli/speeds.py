"""Speeds and other ranges of a performance map, as written on the command line."""

from collections.abc import Mapping

from mechsym.errors import BadInput

_MOST_SPEEDS = 100_000


def parse_speeds(text: str, option: str = "--speeds") -> list[float]:
    """Speeds from A:B:STEP or a list with commas, in rpm.

    Returns
    -------
    omega : list of float
        Crank speeds [rad/s]
    """
    from mechsym.quantities import parse

    parts = text.split(":")
    if len(parts) == 3:
        first, last, step = (parse(part, "-", option) for part in parts)
        if step <= 0 or last < first or (last - first) / step > _MOST_SPEEDS:
            raise BadInput(f"{option} {text}: needs A <= B, STEP > 0 and at most {_MOST_SPEEDS} speeds")
        rpm = [first + k * step for k in range(int((last - first) / step * (1 + 1e-12) + 1e-9) + 1)]
    elif len(parts) == 1:
        rpm = [parse(part, "-", option) for part in text.split(",")]
    else:
        raise BadInput(f"{option} {text}: write A:B:STEP in rpm, for example 500:8000:500")
    if min(rpm) <= 0:
        raise BadInput(f"{option} {text}: speeds must be > 0 rpm")
    return [parse(f"{value!r} rpm", "rad/s") for value in rpm]


def parse_over(text: str, units: Mapping[str, str]) -> tuple[str, list[float]]:
    """A value and its range from NAME=A:B:STEP, with or without units.

    Parameters
    ----------
    text : str
        `compression_ratio=8:14:0.5` or `cycle.ignition=-30 deg:0 deg:1 deg`; the section may be left out where
        only one value has the name
    units : mapping of str to str
        Known names and their SI units

    Returns
    -------
    values : list of float
        In the SI unit of the name [-]
    """
    from mechsym.quantities import parse

    written, _, span = text.partition("=")
    bare = [known for known in units if known.rpartition(".")[2] == written]
    name = bare[0] if len(bare) == 1 else written
    if name not in units:
        raise BadInput(f"--over {text}: {name!r} is not known; names are {', '.join(units)}")
    parts = [parse(part.strip(), units[name], f"--over {name}") for part in span.split(":")]
    if len(parts) != 3 or parts[2] <= 0 or parts[1] < parts[0] or (parts[1] - parts[0]) / parts[2] > _MOST_SPEEDS:
        raise BadInput(f"--over {text}: write NAME=A:B:STEP with A <= B and STEP > 0")
    first, last, step = parts
    return name, [first + k * step for k in range(int((last - first) / step + 1e-9) + 1)]
