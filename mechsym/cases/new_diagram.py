"""A start for a measured pressure: the commented case of an indicator diagram, written from the file and four sizes."""

import os
import re
from importlib import resources
from pathlib import Path

from mechsym.cases.new_engine import PISTON_MASS, ROD_MASS, compression_below_knock, fill
from mechsym.errors import BadInput
from mechsym.files import write_text
from mechsym.quantities import RPM, record
from mechsym.quantities.units import RadPerSecond

_SPARK = 13  # compression ratios below it are of mixture, above of air


@record
class TraceSizes:
    """What is given beside the file of a measured pressure."""

    bore: float  #: [m]
    stroke: float  #: [m]
    rod: float  #: [m]
    compression: float | None  #: Compression ratio; a usual one for the bore without [-]
    speed: float | None  #: [rad/s]


def diagram_case(
    trace: Path, sizes: TraceSizes, folder: Path, recorded: RadPerSecond | None, working: str, scale: str,
    by_time: bool,
) -> str:  # fmt: skip
    """Text of the case.

    folder: where it will stand; the path of the file starts there. recorded: speed by the file's times, None without.
    working: working cycle of the file. scale: how its pressure is scaled. by_time: whether the file has times and no
    angles.
    """
    speed = sizes.speed or recorded
    if speed is None:
        raise BadInput(f"{trace}: the file has no times, so its speed is not known; give it with --speed '1500 rpm'")
    ratio, cube = sizes.compression or compression_below_knock(sizes.bore), sizes.bore**3
    l1, radius = 0.3 * sizes.rod, sizes.stroke / 2
    l2, rod, crank = sizes.rod - l1, ROD_MASS * cube, 8 * PISTON_MASS * cube
    text = resources.files("mechsym.cases").joinpath("starts/diagram.toml").read_text("utf-8")
    n_c, about = (1.30, "mixture with fuel") if ratio < _SPARK else (1.34, "air")
    named = f'recorded_speed = "{speed / RPM:.6g} rpm"   # the file has times and no angles: its speed, even\n'
    filled = fill(
        text, trace=trace.name, bore=1e3 * sizes.bore, stroke=1e3 * sizes.stroke, radius=1e3 * radius, l1=1e3 * l1,
        l2=1e3 * l2, crank=crank, rod=rod, pin=0.2 * PISTON_MASS * cube, piston=0.8 * PISTON_MASS * cube,
        I01=crank * radius**2, IC2=0.8 * rod * l1 * l2, speed=speed / RPM,
        speed_from="as given" if sizes.speed else "by the times of the file", working=working, ratio=ratio,
        ratio_from="as given" if sizes.compression else "ASSUMED, usual for the bore: dead centre and heat hang on it",
        file=_from(folder, trace), columns=named if by_time else "", n_c=n_c, n_from=f"{about}, to 0.06", scale=scale,
        scale_from=_SCALES[scale],
    )  # fmt: skip
    lines = (re.match(r"^(.*?\S) {2,}(# .*)$", line) for line in filled.splitlines())
    told = zip(lines, filled.splitlines(), strict=True)
    return "\n".join(f"{found[1]:<29} {found[2]}" if found else line for found, line in told) + "\n"


_SCALES = {
    "checked": "as read; refused where compression starts from a pressure that no engine has",
    "exhaust": "AS READ IT FITS NO ENGINE: scaled so that the exhaust stroke has 1.05 bar; calibrate the sensor",
}


def _from(folder: Path, trace: Path) -> str:
    """The path of a file as a case in a folder names it."""
    try:
        return Path(os.path.relpath(trace.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        return trace.resolve().as_posix()


def write_diagram(text: str, folder: Path, name: str) -> list[Path]:
    """Write the case; nothing that exists is overwritten."""
    file = folder / f"{name}.toml"
    if file.exists():
        raise BadInput(f"{file} exists; choose another NAME or remove it")
    return [write_text(file, text)]
