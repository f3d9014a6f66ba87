"""A start for an engine of one's own: a full commented case with sized starting values and a firing order.

Sizes follow from bore and stroke by similarity with engines of the kind that run; each line says by which rule. They
are a start to replace, not a design.
"""

import dataclasses
import math
from collections.abc import Callable, Mapping, Sequence
from importlib import resources
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from mechsym.cases import load
from mechsym.cases.cylinder_layout import CylinderLayout, boxer, in_line, in_v, opposed, radial
from mechsym.cycle.kinds import four_stroke
from mechsym.errors import BadInput
from mechsym.files import write_text
from mechsym.mechanisms.crank_train.firing import lateness
from mechsym.mechanisms.crank_train.parameters import CrankTrainParameters, each
from mechsym.plausible import Doubt
from mechsym.quantities import RPM, record
from mechsym.quantities.units import Metre, Pure
from mechsym.torsion.modes import stiffness_factor

_MOST = 12
_COMPRESSION = ((0.1, 10), (0.14, 9), (math.inf, 8))  # widest bore [m], compression ratio below knock
PISTON_MASS = 780  # mass of a piston by the cube of the bore [kg/m^3]
ROD_MASS = 900  # of a rod by the same [kg/m^3]
_DAMPING = 0.12  # of the first mode: no order up to 12 is magnified by more than 5, wherever it is critical
# mean piston speed at the speed of operation, usual at full power [m/s]
_PISTON_SPEED = {"crosshead": 4.7, "ship": 8.0, "small": 10.0, "four-stroke": 12.0}


@record
class _Proportions:
    """Masses and widths of a crank train, and the rules by which they follow from bore and stroke."""

    piston: float  #: What moves with the piston [kg]
    rod: float  #: [kg]
    throw: float  #: With webs and counterweights [kg]
    inertia: float  #: Of a throw with its share of a rod [kg*m^2]
    flywheel: float  #: Of an engine with three throws and more [kg*m^2]
    pin: float  #: Radius of the piston pin, by the bore [-]
    crank: float  #: Radius of crank pins and journals, by the bore [-]
    wide: float  #: Width of the shaft, by the bore [-]
    friction: float  #: Coefficient of the guides [-]
    rules: Mapping[str, str]  #: Of each value, in words


def _trunk(bore: float, stroke: float, flywheel: float = 160.0) -> _Proportions:
    """Of an engine whose pistons guide themselves."""
    piston, rod, square = PISTON_MASS * bore**3, ROD_MASS * bore**3, (stroke / 2) ** 2
    rules = {
        "of_rod": "900 kg/m3 of the cube of the bore", "of_throw": "four pistons",
        "of_guide": "piston skirt, mixed lubrication",
        "of_piston": "780 kg/m3 of the cube of the bore; piston, rings and pin", "of_inertia": "11 piston masses",
        "of_pin": "an eighth of the bore", "of_crank": "0.3 of the bore", "of_flywheel": "piston",
    }  # fmt: skip
    return _Proportions(
        piston=piston, rod=rod, throw=4 * piston, inertia=11 * piston * square, flywheel=flywheel * piston * square,
        pin=1 / 8, crank=0.3, wide=0.6, friction=0.05, rules=rules,
    )  # fmt: skip


def _crossheads(bore: float, stroke: float) -> _Proportions:
    """Of a large two-stroke: masses of a crosshead engine of bore 0.3 m and stroke 1 m, scaled."""
    size, square = bore**2 * stroke / 0.09, (stroke / 2) ** 2
    rod = 150 * size
    rules = {
        "of_rod": "1670 kg/m3 of bore^2 * stroke", "of_throw": "7.5 rods",
        "of_guide": "shoe of the crosshead, oil film",
        "of_piston": "5100 kg/m3 of bore^2 * stroke; piston, its rod and the crosshead", "of_inertia": "3 rod masses",
        "of_pin": "of the crosshead, 0.42 of the bore", "of_crank": "0.55 of the bore", "of_flywheel": "rod",
    }  # fmt: skip
    return _Proportions(
        piston=460 * size, rod=rod, throw=7.5 * rod, inertia=3 * rod * square, flywheel=100 * rod * square,
        pin=0.42, crank=0.55, wide=1.1, friction=0.02, rules=rules,
    )  # fmt: skip


def write_engine(
    kind: str, bore: Metre, stroke: Metre, cylinders: int | None, out: Path, name: str = "", gas: str = "exchange",
    rods: str | None = None,
) -> list[Path]:  # fmt: skip
    """Write the case of a new engine; nothing that exists is overwritten.

    bore, stroke: of a cylinder; of opposed pistons and of a hypocycloid the stroke of one piston. name: stem of the
    file; kind and number of cylinders when left out. gas: of a four-stroke engine, a word of `GASES`. rods: of several
    cylinders on a throw, a word of `RODS`; usual for the kind when left out.
    """
    if rods is not None and kind not in _RODS:
        raise BadInput(f"--rods {rods}: an engine of kind {kind} has one rod on each crank pin; leave --rods away")
    count = _CYLINDERS[kind] if cylinders is None else cylinders
    if not 1 <= count <= _MOST:
        raise BadInput(f"--cylinders {count}: allowed are 1 to {_MOST}")
    hangs = (rods or _RODS.get(kind)) == "articulated"
    if kind in _LAYOUTS:
        lay_out, words = _LAYOUTS[kind]
        layout = lay_out(count, hangs)
        what = words.format(n=count, angle=2 * layout.bank[-1]) if count > 1 else "engine, one cylinder"
        head = _head("crank_train", f"Four-stroke {what}, bore {1e3 * bore:g} mm", stroke, "four-stroke")
        engine = head + _train(layout, bore, stroke, 3.5, _trunk(bore, stroke))
    else:
        engine = _KINDS[kind](bore, stroke, count)
    build = (_crossheads if kind == "two-stroke-crosshead" else _trunk)(bore, stroke)
    text = _detuned(engine + _load_of(kind, gas, bore, stroke), bore, build)
    file = out / f"{name or f'{kind}-{count}'}.toml"
    if file.exists():
        raise BadInput(f"{file} exists; choose another NAME or remove it")
    return [write_text(file, text)]


def _detuned(text: str, bore: float, build: _Proportions) -> str:
    """The text with the shaft of its crank train, if it has one, away from its major orders."""
    if "<k>" not in text:
        return text
    with TemporaryDirectory() as folder:
        first = Path(folder) / "first.toml"
        first.write_text(fill(text, **_shaft(bore, build, 1, 1.0)), encoding="utf-8")
        case = load(str(first))
    parameters, turns = case.need("parameters"), 2 if four_stroke(case.need("cycle")) else 1
    z = sorted(set(each(parameters, "z")))
    long = {"bay": min(np.diff(z)) / bore} if len(z) > 1 else {}
    plain = dataclasses.replace(parameters, k=_shaft(bore, build, 1, 1.0, **long)["k"])
    factor = stiffness_factor(plain, case.need("operation").speed, 2 * math.pi * turns)
    return fill(text, **_shaft(bore, build, max(parameters.throw), factor or 1.0, **long))


def _shaft(bore: float, build: _Proportions, throws: int, factor: Pure, bay: Pure = 1.2) -> dict[str, float]:
    """Stiffness [N*m/rad] and damping [N*m*s/rad] of a section, and the width of its shaft by the bore [-].

    factor: of the stiffness, by that of a shaft as wide as usual. bay: length of a section, by the bore.
    """
    wide = build.wide * factor**0.25
    stiffness = 0.5 * 80e9 * math.pi / 32 * (wide * bore) ** 4 / (bay * bore)
    # first natural frequency of equal throws on equal sections whose flywheel stands still
    first = 2 * math.sqrt(stiffness / build.inertia) * math.sin(math.pi / (4 * throws + 2))
    return {"k": stiffness, "c": 2 * _DAMPING * stiffness / first, "wide": wide}


def _head(mechanism: str, about: str, stroke: float, usual: str) -> str:
    rpm = _PISTON_SPEED[usual] / (2 * stroke) * 60  # at the usual mean piston speed, rounded to two digits
    step = 10 ** (math.floor(math.log10(rpm)) - 1)
    speed = round(rpm / step) * step
    mean = speed * RPM / math.pi * stroke
    return (
        "# Starting values by similarity: replace them by yours, with where each comes from in the comment.\n"
        "# All problems at once: mechsym check FILE. What a key means: mechsym sections SECTION.\n"
        f'mechanism = "{mechanism}"\nsource = "own"\nabout = "{about}; starting values"\n\n'
        f'[operation]\nspeed = "{speed:g} rpm"   # assumed: mean piston speed {mean:.3g} m/s\n'
    )


def _start(name: str) -> str:
    """Sections of a case in `starts/`; `<name>` in it is a number or a list."""
    return "\n" + resources.files("mechsym.cases").joinpath(f"starts/{name}.toml").read_text("utf-8")


def fill(text: str, **values: float | str) -> str:
    """The text with words, and numbers [each in the unit behind its place], in the places `<name>`."""
    for name, value in values.items():
        text = text.replace(f"<{name}>", value if isinstance(value, str) else f"{value:.4g}")
    return text


def _crosshead(bore: float, stroke: float, count: int) -> str:
    if count > 1:
        about = f"Two-stroke engine, {count} cylinders in line with crossheads, bore {1e3 * bore:g} mm"
        row = dataclasses.replace(in_line(count, turns=1), pitch=1.7)
        train = _head("crank_train", about, stroke, "ship") + _train(row, bore, stroke, 2.5, _crossheads(bore, stroke))
        return train + fill(_start("two_stroke_large"), bore=bore * 1e3)
    # masses, spring, guide and limits of an engine of bore 0.3 m and stroke 1 m that can be built, scaled
    size, area = bore**2 * stroke / 0.09, bore**2 / 0.09
    head = _head("crosshead", f"Two-stroke crosshead engine, bore {1e3 * bore:g} mm", stroke, "crosshead")
    mass = {"m1": 80 * size, "m2": 150 * size, "m3": 150 * size, "m4": 200 * size, "m5": 110 * size}
    inertia = {"I01": 30 * size * stroke**2, "IC2": 50 * size * stroke**2}
    values = {"bore": bore * 1e3, "stroke": stroke * 1e3, "area": 0.031 * area, "force": 600 * area}
    values |= {"width": 100 * area / stroke, "offset": 150 * area / stroke}
    lengths = {"r1": 200, "r2": 300, "l1": 800, "l2": 750, "H": 1000, "rho0": 800, "margin": 10, "roller": 100}
    lengths |= {"pin": 120, "crank": 140, "ring": 7}
    scaled = {name: value * stroke for name, value in lengths.items()}
    return fill(
        head + _start("crosshead") + _start("two_stroke_large") + _start("hinge"), **mass, **inertia, **values, **scaled
    )


def _opposed(bore: float, stroke: float, count: int) -> str:
    about = f"Two-stroke engine, {count} cylinder{'s' * (count > 1)} with two opposed pistons, bore {1e3 * bore:g} mm"
    head = _head("crank_train", about, stroke, "small")
    return (
        head
        + _train(opposed(count), bore, stroke, 3.75, _trunk(bore, stroke))
        + fill(_start("two_stroke_small"), bore=bore * 1e3)
    )


def _hypocycloid(bore: float, stroke: float, count: int) -> str:
    if count > 1:
        raise BadInput(f"--cylinders {count}: the mechanism hypocycloid has one piston; give --cylinders 1")
    head = _head("hypocycloid", f"Four-stroke geared hypocycloid, bore {1e3 * bore:g} mm", stroke, "four-stroke")
    size = bore**3
    values = {"e": stroke / 4 * 1e3, "module": stroke / 52 * 1e3, "pin": bore * 1e3 / 4, "I1": 30 * size * stroke**2}
    values |= {"piston": PISTON_MASS * size, "planet": 300 * size, "I2": 300 * size * (stroke / 4) ** 2 / 2}
    values["flywheel"] = 320 * PISTON_MASS * size * (stroke / 2) ** 2
    return head + fill(_start("hypocycloid"), **values)


def compression_below_knock(bore: Metre) -> Pure:
    """A usual compression ratio of mixture: a wide chamber burns longer."""
    return next(ratio for widest, ratio in _COMPRESSION if bore <= widest)


def _load_of(kind: str, gas: str, bore: float, stroke: float) -> str:
    """Chamber, cycle and load of a four-stroke engine, those of others stand with their kind.

    A wide chamber burns longer at its low speed, so that it knocks at a lower compression.
    """
    if kind not in _FOUR_STROKES:
        if gas != "exchange":
            why = f"an engine of kind {kind} has two strokes, its gas is closed for its mean pressure"
            raise BadInput(f"--gas {gas}: {why}; leave --gas away")
        return ""
    inlet, exhaust, swept = 0.34 * bore * 1e3, 0.3 * bore * 1e3, math.pi / 4 * bore**2 * stroke * 1e6
    return fill(
        _start(GASES[gas]), bore=bore * 1e3, ratio=compression_below_knock(bore),
        inlet=inlet, inlet_lift=inlet / 4, exhaust=exhaust, exhaust_lift=exhaust / 4, throttle=0.55 * bore * 1e3,
        tailpipe=0.45 * bore * 1e3, plenum=1.5 * swept, manifold=3 * swept,
    )  # fmt: skip


def _train(layout: CylinderLayout, bore: float, stroke: float, ratio: float, build: _Proportions) -> str:
    """Section `[parameters]` of a crank train but for its shaft: rods of `ratio` crank radii."""
    radius, rod = stroke / 2, ratio * stroke / 2
    piston, rod_mass = build.piston, build.rod
    throws = max(layout.throw)
    # the big end's share, with the centre of mass a third from it
    turning = (rod_mass * 2 / 3 + layout.turned * (piston + rod_mass / 3)) * radius
    unbalance = [-turning * layout.throw.count(k + 1) for k in range(throws)]
    middles = []  # angle half way between the pins of each throw [deg]
    for number in range(1, throws + 1):
        pins = [math.radians(p) for p, k in zip(layout.phase, layout.throw, strict=True) if k == number]
        there = sum(complex(math.cos(p), math.sin(p)) for p in pins)
        angle = round(math.degrees(math.atan2(there.imag, there.real)) % 360, 6)
        middles.append(angle if abs(there) > 1e-9 else 0.0)
    inertia = build.flywheel * (2 if throws < 3 else 1)  # few throws push unevenly
    of_flywheel = {"piston": piston, "rod": rod_mass}[build.rules["of_flywheel"]]
    far = 2 * (radius + rod + bore) + 0.02 * stroke
    ranked = sorted(range(len(layout.firing)), key=lambda i: layout.firing[i])
    together = len(set(layout.firing)) == 1 and len(ranked) > 1
    also = " and half of the oscillating masses, all of their first order" if layout.turned else ""
    row = throws // 2 if layout.opposed else throws  # those of opposed pistons stand beside each other
    lists = {
        "throw": str(list(layout.throw)), "bank": _numbers(layout.bank, "deg"), "phase": _numbers(layout.phase, "deg"),
        "order": (" and " if together else "-").join(str(i + 1) for i in ranked),
        **_rods(layout, bore, radius, rod, rod_mass),
        "weights": f"counterweights balance the turning part of the rods{also}",
        "u0": _numbers(unbalance, "kg*m"), "u_phase": _numbers(middles, "deg"),
        "z": _numbers([k % row * layout.pitch * bore * 1e3 for k in range(throws)], "mm"), "axes": _axes(layout, far),
    }  # fmt: skip
    numbers = {
        "period": layout.period, "r": radius * 1e3, "rod": rod_mass, "piston": piston, "m0": build.throw,
        "I0": build.inertia, "I_f": inertia, "heavy": inertia / (of_flywheel * radius**2), "ratio": ratio,
        "pitch": layout.pitch, "pin": bore * 1e3 * build.pin, "r_crank": build.crank * bore * 1e3,
        "ring": bore * 1e3 / 45, "mu_guide": build.friction,
    }  # fmt: skip
    return fill(_start("train"), **lists, **numbers, **build.rules)


def _rods(layout: CylinderLayout, bore: float, radius: float, rod: float, mass: float) -> dict[str, str]:
    """Lengths and inertia of the rods, where and on which they hang, and when their cylinders fire.

    A rod that hangs is shorter by the radius of its knuckle pin, and its piston not quite at the top when the crank
    points to it.
    """
    firing = layout.firing
    if not layout.master:
        lengths = {"l1": f'"{rod / 3 * 1e3:.4g} mm"', "l2": f'"{rod * 2 / 3 * 1e3:.4g} mm"'}
        inertia = f'"{0.2 * mass * rod**2:.4g} kg*m^2"'
        return lengths | {"I_rod": inertia, "hung": "", "firing": _numbers(firing, "deg")}
    knuckle = 0.45 * bore
    long = [rod - knuckle * bool(m) for m in layout.master]
    from_master = [b - layout.bank[m - 1] if m else 0.0 for b, m in zip(layout.bank, layout.master, strict=True)]
    bank, phase, fires, angles = (
        tuple(map(math.radians, of)) for of in (layout.bank, layout.phase, firing, from_master)
    )
    train = CrankTrainParameters(
        throw=layout.throw, bank=bank, phase=phase, firing=fires, r=radius, l1=tuple(l / 3 for l in long),
        l2=tuple(2 * l / 3 for l in long), master=layout.master, knuckle=knuckle, knuckle_angle=angles,
        m_rod=mass, I_rod=mass * rod**2, m_piston=mass, I0=1.0, I_f=1.0, k=1.0,
    )  # fmt: skip
    tops = tuple((f - math.degrees(late)) % 720 for f, late in zip(firing, lateness(train), strict=True))
    hung = (
        f"master = {list(layout.master)}   # cylinder on whose rod that of each hangs; 0: on the crank pin\n"
        f'knuckle = "{knuckle * 1e3:.4g} mm"   # assumed: knuckle pins at 0.45 of the bore from the crank pin\n'
        f"knuckle_angle = {_numbers(from_master, 'deg')}   # from the master rod; cylinders fire at their own tops\n"
    )
    return {
        "l1": _numbers([l / 3 * 1e3 for l in long], "mm"), "l2": _numbers([l * 2 / 3 * 1e3 for l in long], "mm"),
        "I_rod": _numbers([0.2 * mass * l**2 for l in long], "kg*m^2"), "hung": hung, "firing": _numbers(tops, "deg"),
    }  # fmt: skip


def _axes(layout: CylinderLayout, far: float) -> str:
    if not layout.opposed:
        return ""
    half = max(layout.throw) // 2
    places = _numbers([0.0] * half + [far * 1e3] * half, "mm")
    return (
        f"axis_x = {places}   # assumed: distance of the two cranks\n"
        "sense = 1   # the gears between them have an odd number of wheels\n"
    )


def _numbers(values: Sequence[float], unit: str) -> str:
    return "[" + ", ".join(f'"{v + 0.0:.6g} {unit}"' for v in values) + "]"


def judged(kind: str, bore: Metre, stroke: Metre) -> tuple[Doubt, ...]:
    """Sizes by those in which engines of a kind are built.

    >>> [d.quantity for d in judged("two-stroke-crosshead", 0.086, 0.3)]
    ['--bore']
    """
    narrow, wide, short, long = _BUILT.get(kind, _FOUR_STROKE)
    why = f"engines of kind {kind} are built in other sizes: a slip of the unit, or another --kind?"
    doubts = []
    if not narrow <= bore <= wide:
        doubts.append(Doubt(code="bore", quantity="--bore", value=bore, usual=f"{narrow:g} to {wide:g} m", why=why))
    if not short <= stroke / bore <= long:
        about, usual = "--stroke / --bore", f"{short:g} to {long:g}"
        doubts.append(Doubt(code="stroke_ratio", quantity=about, value=stroke / bore, usual=usual, why=why))
    return tuple(doubts)


# least and largest bore [m], least and largest stroke by bore; a crosshead is for strokes too long for a trunk piston
_BUILT = {
    "two-stroke-crosshead": (0.25, 1.1, 1.3, 5.5),
    "opposed": (0.05, 0.45, 0.8, 2.5),
    "hypocycloid": (0.01, 0.3, 0.4, 2.0),
}
_FOUR_STROKE = (0.01, 0.65, 0.35, 1.8)
# kind: layout of a four-stroke engine, by its number of cylinders and whether rods hang on others, and its words
_LAYOUTS: Mapping[str, tuple[Callable[[int, bool], CylinderLayout], str]] = {
    "inline": (lambda count, _: in_line(count, turns=2), "engine, {n} in line"),
    "v": (in_v, "V{n}, {angle:g} degrees"),
    "boxer": (lambda count, _: boxer(count), "boxer engine, {n} cylinders"),
    "radial": (radial, "radial engine, {n} cylinders"),
}
_KINDS: Mapping[str, Callable[[float, float, int], str]] = {
    "two-stroke-crosshead": _crosshead, "opposed": _opposed, "hypocycloid": _hypocycloid,
}  # fmt: skip
_CYLINDERS = {"two-stroke-crosshead": 1, "inline": 4, "v": 2, "boxer": 4, "radial": 5, "opposed": 1, "hypocycloid": 1}
_FOUR_STROKES = ("inline", "v", "boxer", "radial", "hypocycloid")
RODS = ("side-by-side", "articulated")  #: Of several cylinders on a throw
_RODS = {"v": "side-by-side", "radial": "articulated"}
GASES = {"exchange": "four_stroke", "closed": "four_stroke_closed"}  #: Gas of a four-stroke engine, and its start
KINDS = tuple(_CYLINDERS)
