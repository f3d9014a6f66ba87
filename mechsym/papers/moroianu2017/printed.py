"""Source 001, Moroianu (2017): the force chain of a marine engine, as printed.

F is the total force on the piston along the cylinder axis, alpha the crank angle, beta the rod's. Equations (1) and
(5) are not in the text that we have.
"""

import mechsym.papers.moroianu2017.claims as claims
from mechsym.audit.entries import Listed, Printed, TextClaim

# the paper's F is the gas force and the inertia of the reciprocating masses together
_CHAIN = {"F": "total_force", "alpha": "phi", "B": "rod_force", "R": "r"}

ENTRIES = (
    Printed(equation="2", claim="inertia force of the reciprocating masses", statement="-m_it*a_p",
            letters={"m_it": "m", "a_p": "piston_acceleration"}, quantity="slider_crank.inertia_force"),
    Listed(equation="2", claim="reciprocating mass", statement="m_it = m_p + m_tp + m_bp + m_cc", verdict="definition"),
    Listed(equation="3", claim="centre of mass of the rod after Terskih", verdict="empirical",
           statement="L_m/L = 0.2*((0.001*n)**2 + 2)/((0.001*n)**2 + 1)",
           note="0.40 at low speed; the rod of source 000 has its centre of mass at 0.516 L from the crank pin"),
    Printed(equation="4", claim="share of the rod's mass on the piston", statement="m_b*L_m/L",
            quantity="two_mass_rod.mass_on_piston", note="L_m is measured from the crank pin"),
    Listed(equation="6", claim="reciprocating mass, printed again", verdict="definition",
           statement="m_it = m_p + m_tp + m_bp + m_cc",
           note="the text announces the share on the crank pin, m_b*(1 - L_m/L), which is not printed"),
    Printed(equation="7", claim="total force", statement="F_p + F_it",
            letters={"F_p": "F", "F_it": "inertia_force"}, quantity="slider_crank.total_force"),
    Printed(equation="8", claim="force along the rod", statement="F/cos(beta)", letters=_CHAIN,
            quantity="slider_crank.rod_force"),
    Printed(equation="9", claim="force normal to the cylinder axis", statement="tan(beta)*F", letters=_CHAIN,
            quantity="slider_crank.normal_force"),
    Printed(equation="10", claim="radial force", statement="cos(alpha + beta)*B", letters=_CHAIN,
            quantity="slider_crank.radial_force"),
    Printed(equation="11", claim="tangential force", statement="sin(alpha + beta)*B", letters=_CHAIN,
            quantity="slider_crank.tangential_force"),
    Listed(equation="12", claim="total radial force", statement="Z = Z_B + F_ibm", verdict="definition",
           note="the text says tangential component where it must be radial; F_ibm = -m_bm R omega^2 with Z_B "
                "positive towards the shaft"),
    Printed(equation="13", claim="instantaneous driving moment", statement="T*R",
            letters={"T": "tangential_force", "R": "r"}, quantity="slider_crank.torque"),
    TextClaim(equation="text", claim="two masses at its ends stand for the connecting rod", decide=claims.two_masses),
)  # fmt: skip
