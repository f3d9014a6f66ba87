"""What decides the claims of source 001."""

from mechsym.audit.hosts.sources import Decided
from mechsym.audit.read.algebra import FLOATS
from mechsym.audit.theory.catalogue import theory
from mechsym.audit.theory.record import complete


def two_masses() -> Decided:
    """What the two-mass rod leaves out, for the rod of source 000."""
    rod = theory("two_mass_rod")
    names = {k: letter.value for k, letter in rod.letters.items()}
    complete(rod, names, rod.results, FLOATS)
    missing, own = float(names["inertia_missing"]), float(names["I_C"])
    return Decided(
        supported=False,
        note=f"mass and centre of mass are right, the inertia is not: m_b L_m (L - L_m) instead of I_C, "
        f"{own - missing:.0f} for {own:.0f} kg m^2 with the rod of source 000. The torque is wrong by the difference "
        "times the rod's angular acceleration",
        rel_error=-missing / own,
    )
