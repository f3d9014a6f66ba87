"""The file of an FMU: description, sources, and binaries for the platforms that a compiler is there for.

The token is made from the sources: the same model gives the same token and, without binaries, the same file.
"""

import importlib.util
import platform
import sys
import tempfile
import uuid
import zipfile
from collections.abc import Mapping, Sequence
from importlib import resources
from io import BytesIO
from pathlib import Path

import casadi as ca
import numpy as np

import mechsym
from mechsym import periodic
from mechsym.errors import BadInput
from mechsym.files import write_bytes
from mechsym.hinge.balance import balance
from mechsym.hinge.guide import Guide, closing, path, setting_of, with_setting
from mechsym.hinge.torque import Hinge
from mechsym.machine.loads import ConstantLoad, Load, PropellerLoad
from mechsym.native import compiler
from mechsym.native.compiler import forecast
from mechsym.native.integrators import dop853_numbers
from mechsym.out.block import Block, Curve, Port
from mechsym.out.fmi.describe import build_description, description, identifier
from mechsym.out.text.dialects import C99
from mechsym.out.text.language_c import array, curve_tables, model
from mechsym.periodic.pieces import PPoly
from mechsym.quantities import record
from mechsym.quantities.results import part, quantity, result

ALLOWED = 1e-9  #: Largest difference of an FMU from the simulation, as a share
SYSTEMS = {"linux64": "Linux", "win64": "Windows"}  #: Platforms, by the names that FMI has for them
PLATFORMS = tuple(SYSTEMS)
_NAMESPACE = uuid.UUID("5a1d7bb4-93b8-5b2c-9d3c-0d7e60f2a1c5")
_OPTIONS = ("-std=c99", "-O2", "-shared", "-fPIC", "-fvisibility=hidden", "-ffp-contract=off")
_FOLDERS = {2: {"linux64": "linux64", "win64": "win64"}, 3: {"linux64": "x86_64-linux", "win64": "x86_64-windows"}}
_ENDINGS = {"linux64": "so", "win64": "dll"}
_WINDOWS = "windows.c"  # what stands in for the start-up code of a C library


@record
class Unit:
    """An FMU: its bytes, and what is inside or missing."""

    name: str
    version: int
    token: str
    data: bytes
    platforms: tuple[str, ...]  #: For which there is a binary inside
    binaries: tuple[str, ...]
    missing: Mapping[str, str]  #: platform: why it has no binary


@result
class UnitChecks:
    """What an FMU holds, and how near it comes to the simulation where it was compared."""

    token: str = part()
    binaries: tuple[str, ...] = part()
    missing: Mapping[str, str] = part()  #: Platform, and why it has no binary
    #: Of the states by its equations, largest, as a share of each state's largest value
    difference_me: float | None = quantity("-", default=None, optional=True)
    difference_cs: float | None = quantity("-", default=None, optional=True)  #: The same by its own integrator


@result
class UnitFile:
    """What `mechsym fmu` tells."""

    written: list[str] = part()
    checks: UnitChecks = part()


def fmu(
    block: Block, version: int = 2, platforms: Sequence[str] = ("linux64",), code: Mapping[str, str] | None = None
) -> Unit:
    """The functional mock-up unit of a block, for FMI 2.0 or 3.0; `code` has sources other than those of a machine."""
    if version not in (2, 3):
        raise BadInput(f"--fmi {version} is not allowed; allowed are 2, 3")
    for name in platforms:
        if name not in PLATFORMS:
            raise BadInput(f"--platforms {name!r} is not known; allowed are {', '.join(PLATFORMS)}")
    room = resources.files("mechsym.out")
    if not code:
        core = (room / "c" / "core.h").read_text(encoding="utf-8")
        code = {"core.h": core, "model.h": model(block), "method.h": dop853_numbers() + "\n"}
    main = [f"fmi{version}.c"]
    sources = {main[0]: (room / "fmi" / main[0]).read_text(encoding="utf-8"), **code}
    for header in sorted(p.name for p in (room / "fmi" / "headers").iterdir()):
        if header.startswith(f"fmi{version}"):
            sources[header] = (room / "fmi" / "headers" / header).read_text(encoding="utf-8")
    token = "{" + str(uuid.uuid5(_NAMESPACE, "\n".join(f"{k}\n{v}" for k, v in sources.items()))) + "}"
    prefix = f"#ifndef FMI2_FUNCTION_PREFIX\n#define FMI2_FUNCTION_PREFIX {identifier(block.name)}_\n#endif\n"
    # FMI 3.0 leaves the prefix to who links statically; tools that build a library from sources count on that
    sources["identity.h"] = f'#define TOKEN "{token}"\n' + (prefix if version == 2 else "")
    files: dict[str, str | bytes] = {f"sources/{name}": text for name, text in sources.items()}
    tool = f"mechsym {mechsym.__version__}"
    files["modelDescription.xml"] = description(block, version, token, main, tool)
    if version == 3:
        files["sources/buildDescription.xml"] = build_description(block, main)
    binaries, missing = _binaries(block, version, sources, platforms)
    return Unit(
        name=block.name, version=version, token=token, data=_packed(files | binaries), binaries=tuple(binaries),
        platforms=tuple(name for name in platforms if name not in missing), missing=missing,
    )  # fmt: skip


def write(unit: Unit, path: Path) -> Path:
    """Write an FMU to a file, under a temporary name first."""
    return write_bytes(path, unit.data)


def _binaries(
    block: Block, version: int, sources: Mapping[str, str], platforms: Sequence[str]
) -> tuple[dict[str, bytes], dict[str, str]]:
    binaries, missing = {}, {}
    if platforms:
        forecast(sum(map(len, sources.values())), len(platforms))
    for name in platforms:
        try:
            command, more = _compiler(name)
            place = f"binaries/{_FOLDERS[version][name]}/{identifier(block.name)}.{_ENDINGS[name]}"
            binaries[place] = _compiled(command, more, version, sources)
        except compiler.NoCompiler as error:
            missing[name] = str(error)
    return binaries, missing


def _compiler(name: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    # words before the sources and after them
    host = platform.system() == "Linux" and platform.machine().lower() in ("x86_64", "amd64")
    if name == "linux64" and host:
        return compiler.find().command, ("-lm",)
    zig = importlib.util.find_spec("ziglang")
    if zig is None or not zig.submodule_search_locations:
        raise compiler.NoCompiler(f"no compiler for {name}; install the extra web: pip install 'mechsym[web]'")
    command = (sys.executable, "-m", "ziglang", "cc", "-s", "-target")
    if name == "linux64":
        return (*command, "x86_64-linux-gnu.2.17"), ("-lm",)
    # Windows has a C library; that of the compiler would be built first, for more than a minute
    headers = Path(zig.submodule_search_locations[0]) / "lib" / "libc" / "include" / "any-windows-any"
    parts = [f"-lapi-ms-win-crt-{part}-l1-1-0" for part in ("heap", "math", "string", "private")]
    return (*command, "x86_64-windows-gnu", "-nostdlib", "-isystem", str(headers)), (_WINDOWS, *parts)


def _compiled(command: Sequence[str], more: Sequence[str], version: int, sources: Mapping[str, str]) -> bytes:
    with tempfile.TemporaryDirectory() as folder:
        for name, text in sources.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        if _WINDOWS in more:
            own = resources.files("mechsym.out") / "fmi" / _WINDOWS
            (Path(folder) / _WINDOWS).write_text(own.read_text(encoding="utf-8"), encoding="utf-8")
        target = Path(folder) / "unit.bin"
        # file names are given relative to the folder, so that no path of this machine gets into the binary
        prefix = f"-DFMI{version}_OVERRIDE_FUNCTION_PREFIX"
        words = [*command, *_OPTIONS, prefix, f"fmi{version}.c", *more, "-o", target.name]
        compiler.call(words, "the sources", target, Path(folder))
        binary = target.read_bytes()
        if not binary.startswith((b"\x7fELF", b"MZ")):
            raise compiler.NoCompiler("{} made no library; {}".format(*compiler.way_out(command)))
        return binary


def _packed(files: Mapping[str, str | bytes]) -> bytes:
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name in sorted(files):
            # a fixed date, so that the same model gives the same file
            entry = zipfile.ZipInfo(name, date_time=(1980, 1, 1, 0, 0, 0))
            entry.compress_type = zipfile.ZIP_DEFLATED
            entry.external_attr = 0o644 << 16
            archive.writestr(entry, files[name])
    return buffer.getvalue()


_GAIN, _RATE = 0.7, 0.1  # share of the error taken away in a period; largest change by the design's setting
_TURNS = 20.0  # of the run that the file proposes


def controller(name: str, wanted: Hinge, guide: Guide, load: Load) -> tuple[Block, dict[str, str]]:
    """The ports of the controller of a guide, and the C that is its own: file name to text.

    Raises BadInput: the load is a table, or the gas of the spring exchanges heat: a pascal gives no function of the
    angle then.
    """
    if guide.spring.state:
        raise BadInput("the pressure controller takes springs whose force follows from the closing alone")
    (letter, unit), set_to = guide.spring.setting, float(setting_of(guide.spring))
    # inertia, energy of the spring for each unit of its setting, and the work that is missing by design
    missing = periodic.antiderivative(balance(wanted, guide.parameters.balance).rest)
    curves = {"inertia": wanted.inertia, "unit": _unit_energy(wanted, guide), "design": missing}
    block = Block(
        name=f"{name}-controller", about=f"sets the spring of {name} once in a period, from crank angle and speed",
        states=(), parameters=_parameters(letter, unit, set_to, load), switches=(), kinks=(), stops=(),
        inputs=(
            Port(name="phi", unit="rad", about="crank angle, that of the machine"),
            Port(name="phid", unit="rad/s", start=wanted.omega, about="speed of the crank"),
        ),
        outputs=(
            Port(name=letter, unit=unit, start=set_to, about="setting of the spring"),
            Port(name=f"{letter}_error", unit=unit, about="by how much the last period was off the design"),
            Port(name="periods", unit="-", about="periods that are over"),
        ),
        curves=tuple(Curve(name=name, state=0, poly=poly) for name, poly in curves.items()),
        t_end=_TURNS * 2 * np.pi / wanted.omega, rates=ca.Function("rates", [], []),
        observed=ca.Function("observed", [], []),
    )  # fmt: skip
    core = (resources.files("mechsym.out") / "c" / "controller.h").read_text(encoding="utf-8")
    return block, {"model.h": _model(block, wanted), "core.h": core, "method.h": "\n"}


def _parameters(letter: str, unit: str, set_to: float, load: Load) -> tuple[Port, ...]:
    match load:
        case ConstantLoad(torque=float(torque)):
            speed, power = 1.0, 0.0
        case PropellerLoad(torque=float(torque), speed=float(speed)):
            power = 2.0
        case _:
            raise BadInput("the pressure controller takes a constant load or a propeller; set load.law")
    return (
        Port(name=f"{letter}_design", unit=unit, start=set_to, about="setting that the guide was cut for"),
        Port(name=f"{letter}_start", unit=unit, start=set_to, about="setting before the first period is over"),
        Port(name="gain", unit="-", start=_GAIN, about="share of the error that is taken away in a period"),
        Port(name="rate", unit="-", start=_RATE, about="largest change in a period, by the setting of the design"),
        Port(name="load_torque", unit="N*m", start=torque, about="torque of the load at load_speed"),
        Port(name="load_speed", unit="rad/s", start=speed, about="speed of reference of the load"),
        Port(name="load_power", unit="-", start=power, about="power of the speed with which the load grows"),
    )


def _unit_energy(wanted: Hinge, guide: Guide) -> PPoly:
    """Energy of the spring by its setting over the crank angle [J/Pa], [J/N] of a coil."""
    ratio, rho, at = guide.parameters.shaft_ratio, path(guide), setting_of(guide.spring)
    low, high = (with_setting(guide.spring, share * at) for share in (1.0, 2.0))

    def energy(phi: np.ndarray) -> np.ndarray:
        theta = rho.x[0] + (ratio * phi - rho.x[0]) % (rho.x[-1] - rho.x[0])
        z = closing(guide, rho(theta))
        # the energy is linear in the setting
        return np.asarray((high.energy(z) - low.energy(z)) / at)

    return periodic.fit(energy, (*rho.x / ratio, *(rho.x + rho.x[-1]) / ratio), wanted.period, 1e-10)


def _model(block: Block, wanted: Hinge) -> str:
    sizes = {"NU": len(block.inputs), "NP": len(block.parameters), "NY": len(block.outputs)}
    return "\n".join(
        [
            C99.says(f"{block.name}: {block.about}"),
            "enum { " + ", ".join(f"{k} = {v}" for k, v in sizes.items()) + " };",
            f"static const double PERIOD = {wanted.period!r};",
            array("start_p", [port.start for port in block.parameters]),
            curve_tables(block.curves),
            "struct stop { const char *name; };",
            'static const struct stop stops[] = {{""}};',
        ]
    )
