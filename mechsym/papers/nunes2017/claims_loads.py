"""What decides the claims of source 004 on masses, balance, bearings and on the engine as chosen."""

import numpy as np

from mechsym.audit.entries import Decided
from mechsym.cases import load
from mechsym.cycle.chamber import chamber, piston_force
from mechsym.cycle.kinds.printed import marched
from mechsym.jobs.cycle import engine, speed_range
from mechsym.jobs.size import check_printed
from mechsym.papers.nunes2017 import errata as nunes2017_errata
from mechsym.papers.nunes2017.claims_record import against, right
from mechsym.quantities import RPM, dimension
from mechsym.sizing.loads import journal_load_massless, tooth_load_printed
from mechsym.sizing.rules import bearing_data, bearings

_PRESSURE_ANGLE = np.radians(25)


def moving_mass() -> Decided:
    """The mass of the thesis's own parts on the cylinder axis, and what it changes at 8000 rpm."""
    found = nunes2017_errata.reciprocating_mass()
    mass = found["mass_kg"]

    def change(name: str) -> str:
        return f"from {found[f'{name} as printed']:.0f} to {found[f'{name} own parts']:.0f} N"

    return against(0.250, mass, (
        f"crankpin, webs and their bearings move on the cylinder axis too: {mass:.3f} kg with the thesis's own parts; "
        f"at 8000 rpm the largest force goes {change('force_max')}, the force at the exhaust dead centre "
        f"{change('force_at_exhaust_tdc')}, the reversed tooth load {change('tooth_load_reversed')}; the peaks that "
        "size the parts lie at low speed and change little"
    ))  # fmt: skip


def unbalance_unit() -> Decided:
    """The unit of mass times distance."""
    fits = dimension("g*mm") == dimension("g*mm/s^2")
    return Decided(
        supported=fits,
        note="the unit of m b is g mm; no acceleration is left in (4.37), and that of (4.36) is the centripetal "
        "omega^2 b; the numbers are right",
    )


def balance() -> Decided:
    """The moments of both shaft sets against those of the moving parts.

    Returns
    -------
    decided : Decided
        Within a part in a thousand
    """
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
    """Rating of a set of two after ISO 281.

    Returns
    -------
    decided : Decided
        Below the sum, and below the peak load
    """
    rating = float(bearings.set_rating(15.1e3, 2, "drawn-cup"))
    return against(30.2e3, rating, (
        f"ratings do not add: ISO 281 has 2^(7/9), {rating / 1e3:.1f} kN, which is less than the largest load of "
        "27.14 kN; but the peak load belongs to the static rating, 2 x 24 kN, which holds it, and the dynamic rating "
        "to the life"
    ))  # fmt: skip


def journal_load() -> Decided:
    """Largest load of the planet's journals over all speeds and angles.

    Returns
    -------
    decided : Decided
        From the balance of a planet without mass
    """
    machine = engine(load("nunes-hypocycloid", {"cycle.method": "nunes2017_printed"}))
    result = marched(machine, speed_range(load("nunes-hypocycloid").need("speeds")))
    theta = np.radians(result.theta_deg - 360.0)
    room = chamber(machine.chamber, machine.motion)
    force = piston_force(room, theta[:, None], result.omega[None, :], result.p).T
    plain = float(journal_load_massless(force, theta).max())
    full = float(_with_separation(force, theta).max())
    assumed = float(force.max())
    return against(assumed, full, (
        f"the tooth load stands on the journals too: F sqrt(1 + 3 sin^2 theta), at most {plain / 1e3:.1f} kN, "
        f"{full / 1e3:.1f} kN with the separating force at 25 degrees, both sides together, for the "
        f"{assumed / 1e3:.2f} kN (2 x {assumed / 2e3:.2f}) assumed"
    ))  # fmt: skip


def journal_speed() -> Decided:
    """Speed of the planet against its carrier, with the limit of table 4.16."""
    speed, limit = 2 * 8000, bearing_data.catalogue()["HN 1516"].limiting / RPM
    return Decided(
        supported=speed <= limit,
        note=f"the planet turns against its carrier with twice the speed of the crank, {speed} rpm at 8000 rpm; the "
        f"limiting speed is {limit:.0f} rpm, so the crank may have {limit / 2:.0f} rpm",
        rel_error=8000 / speed - 1,
    )


def engine_mass() -> Decided:
    """Sum of the printed masses.

    Returns
    -------
    decided : Decided
        With the numbers of parts that give it
    """
    total = right("mass of the engine [g]")
    return against(13406.6, total, (
        f"{total:.1f} g with four of each bearing but eight HN 1516, four gear sets, two of all other parts and one "
        "cylinder, without belt"
    ), within=1e-5)  # fmt: skip


def chosen_parts() -> Decided:
    """The checks of the printed parts with consistent masses and loads.

    Returns
    -------
    decided : Decided
        Which factors are below the wanted ones
    """
    found = check_printed(load("nunes-hypocycloid"))
    checks = [row for row in found.rows if row["limit"] is not None]
    below = [row for row in checks if not row["holds"]]
    told = ", ".join(
        f"{row['component']} ({row['quantity']}, {row['safety_factor']:.3g} for {row['wanted']:g})" for row in below
    )
    return Decided(
        supported=not below,
        note=f"with the loads of the converged cycle and the masses of the parts, {len(below)} of {len(checks)} "
        f"factors are below the wanted ones: {told}",
    )


def _with_separation(force: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Journal load with the teeth pushed apart: rod force along the cylinder, teeth across and along the crank."""
    teeth = tooth_load_printed(force, theta)
    apart = np.abs(teeth) * np.tan(_PRESSURE_ANGLE)
    sine, cosine = np.sin(theta), np.cos(theta)
    along = -force - teeth * sine - apart * cosine
    return np.hypot(along, teeth * cosine - apart * sine)
