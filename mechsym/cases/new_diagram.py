"""A start for a measured pressure: the commented case of an indicator diagram, written from the file and four sizes."""

import keyword
import os
import re
import sys
import tomllib
from importlib import resources
from pathlib import Path

from mechsym import mechanisms
from mechsym.cases.new_engine import PISTON_MASS, ROD_MASS, compression_below_knock, fill
from mechsym.errors import BadInput
from mechsym.files import together, write_text
from mechsym.files.trust import keep
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
    trace: Path, sizes: TraceSizes, folder: Path, recorded: RadPerSecond | None, working: str, scale: str, by_time: bool
) -> str:
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
    try:  # the path of the file as a case in the folder names it
        file = Path(os.path.relpath(trace.resolve(), folder.resolve())).as_posix()
    except ValueError:  # another drive
        file = trace.resolve().as_posix()
    filled = fill(
        text, trace=trace.name, bore=1e3 * sizes.bore, stroke=1e3 * sizes.stroke, radius=1e3 * radius, l1=1e3 * l1,
        l2=1e3 * l2, crank=crank, rod=rod, pin=0.2 * PISTON_MASS * cube, piston=0.8 * PISTON_MASS * cube,
        I01=crank * radius**2, IC2=0.8 * rod * l1 * l2, speed=speed / RPM,
        speed_from="as given" if sizes.speed else "by the times of the file", working=working, ratio=ratio,
        ratio_from="as given" if sizes.compression else "ASSUMED, usual for the bore: dead centre and heat hang on it",
        file=file, columns=named if by_time else "", n_c=n_c, n_from=f"{about}, to 0.06", scale=scale,
        scale_from=_SCALES[scale],
    )  # fmt: skip
    lines = (re.match(r"^(.*?\S) {2,}(# .*)$", line) for line in filled.splitlines())
    pairs = zip(lines, filled.splitlines(), strict=True)
    return "\n".join(f"{matched[1]:<29} {matched[2]}" if matched else line for matched, line in pairs) + "\n"


_SCALES = {
    "checked": "as read; refused where compression starts from a pressure that no engine has",
    "exhaust": "AS READ IT FITS NO ENGINE: scaled so that the exhaust stroke has 1.05 bar; calibrate the sensor",
}


def write_diagram(text: str, folder: Path, name: str) -> list[Path]:
    """Write the case; nothing that exists is overwritten."""
    file = folder / f"{name}.toml"
    if file.exists():
        raise BadInput(f"{file} exists; choose another NAME or remove it")
    return [write_text(file, text)]


_MODULES = ("casadi", "mechsym", "numpy", "pytest", "scipy", "sympy")  # that a declaration or its test reads


def write(name: str, folder: Path) -> list[Path]:
    """Write declaration, case and test of a new mechanism; nothing that exists is overwritten."""
    if not name.isidentifier() or name.startswith("_") or keyword.iskeyword(name):
        raise BadInput(f"{name!r} cannot name a mechanism; use letters, digits and inner underscores")
    if name in mechanisms.names():
        raise BadInput(f"{name} is a built-in mechanism; choose another NAME, for example {name}_own")
    if name in sys.stdlib_module_names or name in _MODULES:
        raise BadInput(f"{name}.py would hide Python's module {name} from what stands beside it; choose another NAME")
    starts = tomllib.loads(resources.files("mechsym.cases").joinpath("starts/mechanism.toml").read_text("utf-8"))
    texts = {f"{name}.py": starts["declaration"], f"{name}.toml": starts["case"], f"test_{name}.py": starts["test"]}
    with together(folder):
        for file in texts:
            if (folder / file).exists():
                raise BadInput(f"{folder / file} exists; choose another name or remove it")
        written = [write_text(folder / file, text.replace("NAME", name)) for file, text in texts.items()]
    keep(folder)
    return written
