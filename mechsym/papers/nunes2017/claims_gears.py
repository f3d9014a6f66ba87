"""What decides the claims of source 004 on its gears: one mesh, not two wheels."""

import numpy as np

from mechsym.audit.entries import Decided
from mechsym.audit.verdict import Decision
from mechsym.papers.nunes2017 import gears as printed
from mechsym.papers.nunes2017.claims_record import against, items, peaks, right
from mechsym.papers.nunes2017.sizing_numbers import GEOMETRY
from mechsym.quantities import RPM
from mechsym.sizing.rules import gear_factors
from mechsym.sizing.rules import gears as agma

_TEETH = (26, 52)  # of the pinion, in tables 4.8 to 4.12
_CHOSEN, _SHIFT = 39.0, 0.5  # face width [mm], addendum modification
_FEET = 60 / 0.3048  # feet per minute of 1 m/s


def modules() -> Decided:
    """The modules of the tooth numbers of table 4.8."""
    found = [printed.D_PINION * 1e3 / z for z in _TEETH]
    return Decided(
        supported=False,
        note=f"26 mm of the pinion over {_TEETH[0]} and {_TEETH[1]} teeth are modules {found[0]:g} and {found[1]:g}; "
        f"table 4.11 fits {found[1]:g} only",
        rel_error=2 / found[1] - 1,
    )


def centre_distance() -> Decided:
    """Half the difference of the pitch diameters of an internal pair."""
    correct = (printed.D_RING - printed.D_PINION) / 2 * 1e3
    return against(26.0, correct, f"{correct:.0f} mm, (52 - 26)/2 of an internal pair, the throw of the crank")


def dedenda() -> Decided:
    """Whole depth less addendum."""
    pinion, ring = (right(f"dedendum of the {name}, table 4.13 [mm]") for name in ("pinion", "gear"))
    return against(0.5, pinion, (
        f"{pinion:.2f} and {ring:.2f} mm: with the addenda of 1.5 and 0.5 mm the printed ones add to the working depth "
        "of 2 mm, not to the whole depth of 2.35 mm, and leave no clearance"
    ))  # fmt: skip


def load_distribution() -> Decided:
    """K_m of the mesh."""
    mesh = printed.load_distribution_printed(1)
    return against(1.1349, mesh, (
        f"both are the AGMA formula, but it belongs to the mesh and has the pinion's diameter: {mesh:.4f} for both; "
        f"the ring needs {100 * (mesh / 1.1349 - 1):.1f} % more width"
    ))  # fmt: skip


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
    speed = float(agma.mesh_speed(printed.D_PINION, 8000 * RPM))
    return (
        f"at 8000 rpm the teeth meet with {speed:.2f} m/s and not with {speed / 2:.2f} m/s, K_v is {true:.4f} for "
        f"{half:.4f}; the pinion of table 4.12 needs {_pinion_contact():.2f} mm in contact for the 39 mm chosen"
    )


def dynamic_members() -> Decided:
    """K_v of the mesh."""
    mesh = right("K_v, pinion, 8000 rpm")
    return against(1.1073, mesh, (
        f"both mesh with the same speed, that of the planet against its carrier: {mesh:.4f} for both"
    ))  # fmt: skip


def elastic_coefficient() -> Decided:
    """Z_E of steel on steel."""
    pascal = float(gear_factors.elastic_coefficient(200e9, 0.3, 200e9, 0.3))
    return against(1.8703e5, pascal / 1e3, (
        f"{pascal:.5g} Pa^0.5, {pascal / 1e3:.2f} (N/mm^2)^0.5: the unit is wrong; the face widths use the right one"
    ))  # fmt: skip


def ring_contact() -> Decided:
    """The ring's face width with the pinion's diameter in (2.78), all else as printed."""
    item = f"table 4.11: face width, contact, gear, x = {_SHIFT:g}, 26/52 teeth [mm]"
    width = float(items()[item]["computed"])
    shared = width * printed.D_RING / printed.D_PINION
    return against(width, shared, (
        "AGMA 2101 has the pinion's diameter in (2.78) for both members, since both flanks touch with one pressure; "
        f"the ring's {width:.2f} mm are {shared:.2f} mm, and all twelve ring widths of tables 4.11 and 4.12 are halved"
    ))  # fmt: skip


def face_width() -> Decided:
    """The widths of the chosen pair with one mesh, and with the geometry of the internal pair."""
    own = peaks()
    pinion, ring, contact = (1e3 * b for b in printed.widths_corrected(_SHIFT, 26, own["rpm"], own["tooth"]))
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
    """Face width of the maraging steel over that of Nitralloy N.

    Returns
    -------
    decided : Decided
        Not with the geometry of the internal pair
    """
    claim = "maraging 350: face width over Nitralloy's, 'reduced in at least half'"
    chosen, anew = (items()[f"{claim}, {which}"] for which in ("the chosen pair", "shift chosen anew"))
    return against(0.5, float(chosen["computed"]), (
        f"{chosen['computed']:.3f} for the chosen pair by the thesis's own rules: bending of the ring governs and "
        f"gains 54 % only; {anew['computed']:.3f} with the addendum modification chosen anew, "
        f"{chosen['corrected']:.3f} with the contact of the internal pair, where bending always governs"
    ))  # fmt: skip


def _pinion_contact() -> float:
    """Face width of the chosen pinion in contact, as table 4.12 but with the speed of the mesh [mm]."""
    own = peaks()
    load = 0.5 * np.max(own["tooth"] * printed.dynamic_printed(2, own["rpm"], _FEET))
    factors = agma.LoadFactors(K_m=printed.load_distribution_printed(1))
    I = float(GEOMETRY[_SHIFT, 26][0])
    return 1e3 * float(agma.face_width_contact(load, printed.D_PINION, I, 187030.0, 1300e6, factors))
