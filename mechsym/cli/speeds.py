"""Speeds and other ranges of a performance map, as written on the command line."""

from collections.abc import Mapping

from mechsym.errors import BadInput
from mechsym.quantities.ranges import values
from mechsym.quantities.units import RadPerSecond


def parse_speeds(text: str, option: str = "--speeds") -> list[RadPerSecond]:
    """Speeds from a list or a range, in rpm where no unit is written."""
    omega = values(text, "rad/s", option, "rpm", most=20_000)
    if min(omega) <= 0:
        raise BadInput(f"{option} {text}: speeds must be > 0 rpm")
    return omega


def parse_over(text: str, units: Mapping[str, str]) -> tuple[str, list[float]]:
    """A value and what it runs over from NAME=RANGE, with or without units.

    text: `compression_ratio=8:14:0.5` or `cycle.ignition=-30..0 deg:7`; the section may be left out where only one
    value has the name. units: known names and their SI units. Returns values: in the SI unit of the name [-].
    """
    written, _, span = text.partition("=")
    bare = [known for known in units if known.rpartition(".")[2] == written]
    name = bare[0] if len(bare) == 1 else written
    if name not in units:
        raise BadInput(f"--over {text}: {name!r} is not known; names are {', '.join(units)}")
    return name, values(span, units[name], "--over", key=name)
