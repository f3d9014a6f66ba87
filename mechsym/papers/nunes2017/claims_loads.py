"""What decides the claims of source 004 on masses, balance, bearings, the engine as chosen, and on its gears."""

import numpy as np

from mechsym.audit.hosts.sources import Decided
from mechsym.audit.verdict import Decision
from mechsym.cases import load
from mechsym.cycle.chamber import chamber, piston_force
from mechsym.cycle.kinds.printed import marched
from mechsym.jobs.cycle import engine, speed_range
from mechsym.jobs.size import check_printed
from mechsym.papers.nunes2017 import chapter4 as printed
from mechsym.papers.nunes2017 import errata
from mechsym.papers.nunes2017.claims import against, computed, right
from mechsym.quantities import RPM, dimension
from mechsym.sizing.loads import journal_load_massless, tooth_load_printed
from mechsym.sizing.rules import bearings, gears

_PRESSURE_ANGLE = np.radians(25)


def moving_mass() -> Decided:
    """The mass of the thesis's own parts on the cylinder axis, and what it changes at 8000 rpm."""
    figures = errata.reciprocating_mass()
    mass = figures["mass_kg"]

    def change(name: str) -> str:
        return f"from {figures[f'{name} as printed']:.0f} to {figures[f'{name} own parts']:.0f} N"

    note = (
        f"crankpin, webs and their bearings move on the cylinder axis too: {mass:.3f} kg with the thesis's own parts; "
        f"at 8000 rpm the largest force goes {change('force_max')}, the force at the exhaust dead centre "
        f"{change('force_at_exhaust_tdc')}, the reversed tooth load {change('tooth_load_reversed')}; the peaks that "
        "size the parts lie at low speed and change little"
    )
    return against(0.250, mass, note)


def unbalance_unit() -> Decided:
    """The unit of mass times distance."""
    fits = dimension("g*mm") == dimension("g*mm/s^2")
    return Decided(
        supported=fits,
        note="the unit of m b is g mm; no acceleration is left in (4.37), and that of (4.36) is the centripetal "
        "omega^2 b; the numbers are right",
    )


def balance() -> Decided:
    """The moments of both shaft sets against those of the moving parts."""
    moving = right("unbalance of the moving parts [g.mm]")
    left = [right(f"balance of the {which} shaft set [g.mm]") for which in ("output", "support")]
    rest = moving + left[0]
    return Decided(
        supported=abs(rest / moving) < 5e-3,
        note=f"{moving:.1f} g mm against {left[0]:.1f} g mm ({left[1]:.1f} g mm of the support shaft set, without its "
        f"sign): {100 * rest / moving:.1f} % are left",
        rel_error=rest / moving,
    )


def rod_bearing_rating() -> Decided:
    """Rating of a set of two after ISO 281."""
    rating = float(bearings.set_rating(15.1e3, 2, "drawn-cup"))
    note = (
        f"ratings do not add: ISO 281 has 2^(7/9), {rating / 1e3:.1f} kN, which is less than the largest load of "
        "27.14 kN; but the peak load belongs to the static rating, 2 x 24 kN, which holds it, and the dynamic rating "
        "to the life"
    )
    return against(30.2e3, rating, note)


def journal_load() -> Decided:
    """Largest load of the planet's journals over all speeds and angles."""
    machine = engine(load("nunes-hypocycloid", {"cycle.method": "nunes2017_printed"}))
    result = marched(machine, speed_range(load("nunes-hypocycloid").need("speeds")))
    theta = np.radians(result.theta_deg - 360.0)
    room = chamber(machine.chamber, machine.motion)
    force = piston_force(room, theta[:, None], result.omega[None, :], result.p).T
    plain = float(journal_load_massless(force, theta).max())
    full = float(_with_separation(force, theta).max())
    assumed = float(force.max())
    note = (
        f"the tooth load stands on the journals too: F sqrt(1 + 3 sin^2 theta), at most {plain / 1e3:.1f} kN, "
        f"{full / 1e3:.1f} kN with the separating force at 25 degrees, both sides together, for the "
        f"{assumed / 1e3:.2f} kN (2 x {assumed / 2e3:.2f}) assumed"
    )
    return against(assumed, full, note)


def _with_separation(force: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Journal load with the teeth pushed apart: rod force along the cylinder, teeth across and along the crank."""
    teeth = tooth_load_printed(force, theta)
    apart = np.abs(teeth) * np.tan(_PRESSURE_ANGLE)
    sine, cosine = np.sin(theta), np.cos(theta)
    along = -force - teeth * sine - apart * cosine
    return np.hypot(along, teeth * cosine - apart * sine)


def journal_speed() -> Decided:
    """Speed of the planet against its carrier, with the limit of table 4.16."""
    speed, limit = 2 * 8000, bearings.catalogue()["HN 1516"].limiting / RPM
    return Decided(
        supported=speed <= limit,
        note=f"the planet turns against its carrier with twice the speed of the crank, {speed} rpm at 8000 rpm; the "
        f"limiting speed is {limit:.0f} rpm, so the crank may have {limit / 2:.0f} rpm",
        rel_error=8000 / speed - 1,
    )


def engine_mass() -> Decided:
    """Sum of the printed masses."""
    total = right("mass of the engine [g]")
    note = (
        f"{total:.1f} g with four of each bearing but eight HN 1516, four gear sets, two of all other parts and one "
        "cylinder, without belt"
    )
    return against(13406.6, total, note, within=1e-5)


def chosen_parts() -> Decided:
    """The checks of the printed parts with consistent masses and loads."""
    checked = check_printed(load("nunes-hypocycloid"))
    checks = [row for row in checked.rows if row["limit"] is not None]
    below = [row for row in checks if not row["holds"]]
    told = ", ".join(
        f"{row['component']} ({row['quantity']}, {row['safety_factor']:.3g} for {row['wanted']:g})" for row in below
    )
    return Decided(
        supported=not below,
        note=f"with the loads of the converged cycle and the masses of the parts, {len(below)} of {len(checks)} "
        f"factors are below the wanted ones: {told}",
    )


_TEETH = (26, 52)  # of the pinion, in tables 4.8 to 4.12
_CHOSEN, _SHIFT = 39.0, 0.5  # face width [mm], addendum modification
_FEET = 60 / 0.3048  # feet per minute of 1 m/s


def modules() -> Decided:
    """The modules of the tooth numbers of table 4.8."""
    sizes = [printed.D_PINION * 1e3 / z for z in _TEETH]
    return Decided(
        supported=False,
        note=f"26 mm of the pinion over {_TEETH[0]} and {_TEETH[1]} teeth are modules {sizes[0]:g} and {sizes[1]:g}; "
        f"table 4.11 fits {sizes[1]:g} only",
        rel_error=2 / sizes[1] - 1,
    )


def centre_distance() -> Decided:
    """Half the difference of the pitch diameters of an internal pair."""
    correct = (printed.D_RING - printed.D_PINION) / 2 * 1e3
    return against(26.0, correct, f"{correct:.0f} mm, (52 - 26)/2 of an internal pair, the throw of the crank")


def dedenda() -> Decided:
    """Whole depth less addendum."""
    pinion, ring = (right(f"dedendum of the {name}, table 4.13 [mm]") for name in ("pinion", "gear"))
    note = (
        f"{pinion:.2f} and {ring:.2f} mm: with the addenda of 1.5 and 0.5 mm the printed ones add to the working depth "
        "of 2 mm, not to the whole depth of 2.35 mm, and leave no clearance"
    )
    return against(0.5, pinion, note)


def load_distribution() -> Decided:
    """K_m of the mesh."""
    mesh = printed.load_distribution_printed(1)
    note = (
        f"both are the AGMA formula, but it belongs to the mesh and has the pinion's diameter: {mesh:.4f} for both; "
        f"the ring needs {100 * (mesh / 1.1349 - 1):.1f} % more width"
    )
    return against(1.1349, mesh, note)


def dynamic_constant() -> Decided:
    """K_v with 200 and with 196.85."""
    exact, round_ = (float(printed.dynamic_printed(2, 8000, c)) for c in (_FEET, 200.0))
    return Decided(
        supported=False,
        note=f"table 4.10 takes {_FEET:.2f} (K_v = {exact:.4f} at 8000 rpm), tables 4.11 and 4.12 take the 200 of "
        f"(4.25) ({round_:.4f}): {100 * (round_ / exact - 1):.2f} % in the face width, on the safe side",
        rel_error=round_ / exact - 1,
    )


def mesh_speed_effect(verdict: Decision) -> str:
    """What the pinion's half speed costs in K_v and in the width of the pinion."""
    half, true = (float(printed.dynamic_printed(member, 8000, _FEET)) for member in (1, 2))
    speed = float(gears.mesh_speed(printed.D_PINION, 8000 * RPM))
    return (
        f"at 8000 rpm the teeth meet with {speed:.2f} m/s and not with {speed / 2:.2f} m/s, K_v is {true:.4f} for "
        f"{half:.4f}; the pinion of table 4.12 needs {_pinion_contact():.2f} mm in contact for the 39 mm chosen"
    )


def dynamic_members() -> Decided:
    """K_v of the mesh."""
    mesh = right("K_v, pinion, 8000 rpm")
    note = f"both mesh with the same speed, that of the planet against its carrier: {mesh:.4f} for both"
    return against(1.1073, mesh, note)


def elastic_coefficient() -> Decided:
    """Z_E of steel on steel."""
    pascal = float(gears.elastic_coefficient(200e9, 0.3, 200e9, 0.3))
    note = f"{pascal:.5g} Pa^0.5, {pascal / 1e3:.2f} (N/mm^2)^0.5: the unit is wrong; the face widths use the right one"
    return against(1.8703e5, pascal / 1e3, note)


def ring_contact() -> Decided:
    """The ring's face width with the pinion's diameter in (2.78), all else as printed."""
    item = f"table 4.11: face width, contact, gear, x = {_SHIFT:g}, 26/52 teeth [mm]"
    width = computed(item)
    shared = width * printed.D_RING / printed.D_PINION
    note = (
        "AGMA 2101 has the pinion's diameter in (2.78) for both members, since both flanks touch with one pressure; "
        f"the ring's {width:.2f} mm are {shared:.2f} mm, and all twelve ring widths of tables 4.11 and 4.12 are halved"
    )
    return against(width, shared, note)


def face_width() -> Decided:
    """The widths of the chosen pair with one mesh, and with the geometry of the internal pair."""
    own = printed.chapter4().peaks
    pinion, ring, contact = (1e3 * b for b in printed.widths_corrected(_SHIFT, 26, own.rpm, own.tooth))
    fits = max(pinion, ring, contact) <= _CHOSEN
    return Decided(
        supported=fits and _pinion_contact() <= _CHOSEN,
        note=f"with the mesh's speed and all else as in table 4.12 the pinion needs {_pinion_contact():.2f} mm in "
        f"contact, so 39 mm do not keep the factor of 1 by the thesis's own rule; with I of the internal pair contact "
        f"needs {contact:.1f} mm, and bending governs: pinion {pinion:.1f} mm, ring {ring:.1f} mm, which 39 mm hold at "
        "a factor of 1 only, with the load shared evenly by both sets and never reversed",
        rel_error=_CHOSEN / _pinion_contact() - 1,
    )


def maraging() -> Decided:
    """Face width of the maraging steel over that of Nitralloy N."""
    claim = "maraging 350: face width over Nitralloy's, 'reduced in at least half'"
    chosen, anew = (f"{claim}, {which}" for which in ("the chosen pair", "shift chosen anew"))
    note = (
        f"{computed(chosen):.3f} for the chosen pair by the thesis's own rules: bending of the ring governs and "
        f"gains 54 % only; {computed(anew):.3f} with the addendum modification chosen anew, "
        f"{right(chosen):.3f} with the contact of the internal pair, where bending always governs"
    )
    return against(0.5, computed(chosen), note)


def _pinion_contact() -> float:
    """Face width of the chosen pinion in contact, as table 4.12 but with the speed of the mesh [mm]."""
    own = printed.chapter4().peaks
    load = 0.5 * np.max(own.tooth * printed.dynamic_printed(2, own.rpm, _FEET))
    factors = gears.LoadFactors(K_m=printed.load_distribution_printed(1))
    I = float(printed.GEOMETRY[_SHIFT, 26][0])
    return 1e3 * float(gears.face_width_contact(load, printed.D_PINION, I, 187030.0, 1300e6, factors))
