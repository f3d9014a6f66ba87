"""Source 003, Prymak (undated, in Ukrainian): forces in rodless (Balandin) mechanisms, as printed.

P_g and P_j are gas and inertia force along the cylinder, phi and beta the angles of crank and rod; the sums run over
the four rod journals.
"""

import mechsym.papers.prymak.claims as claims
from mechsym.audit.entries import Listed, Printed, TextClaim

_CHAIN = {"P": "total_force", "P_g": "F", "P_j": "inertia_force"}
_STEADY = {"phidd": 0.0}

ENTRIES = (
    Printed(equation="1", claim="load of a rod journal", statement="sqrt((P_g + P_j)**2 + X_i**2)",
            quantity="rodless.journal_load",
            note="printed with a double sign before P_j: its sign depends on the axis"),
    Printed(equation="2", claim="side force of the piston of a slider crank", statement="(P_g + P_j)*tan(beta)",
            letters=_CHAIN, quantity="slider_crank.normal_force"),
    Printed(equation="3", claim="total force on the piston", statement="P_g + P_j", letters=_CHAIN,
            quantity="slider_crank.total_force"),
    Printed(equation="4", claim="resultant inertia force of the four journals",
            statement="sqrt(sum(P_jy**2 + P_jx**2))",
            quantity="rodless.inertia_resultant", hold={"alphadd": 0.0}, effect=claims.root_effect,
            note="one root over sums of squares: it gives 2 sqrt(2) m r omega^2"),
    Printed(equation="4", claim="its size", statement="4*m_n*r*omega**2", letters={"m_n": "m", "omega": "alphad"},
            hold={"alphadd": 0.0}, quantity="rodless.inertia_resultant_equal"),
    Printed(equation="5", claim="tangent of its direction by the sums", statement="sum(P_jx)/sum(P_jy)",
            hold={"alphadd": 0.0}, quantity="rodless.direction"),
    Printed(equation="5", claim="tangent of its direction",
            statement="(-4*m*r*omega**2*sin(alpha))/(-4*m*r*omega**2*cos(alpha))",
            letters={"omega": "alphad"}, hold={"alphadd": 0.0}, quantity="rodless.direction_equal"),
    Printed(equation="5", claim="it is the crank angle", statement="tan(alpha)", hold={"alphadd": 0.0},
            quantity="rodless.direction_equal"),
    Printed(equation="6", claim="inertia force of a slider crank",
            statement="-m_j*R*omega**2*(cos(phi) + lam*cos(2*phi))",
            letters={"m_j": "m", "R": "r", "omega": "phid"}, hold=_STEADY, quantity="slider_crank.inertia_force"),
    Printed(equation="7", claim="force along the rod", statement="P*(1/cos(beta))", letters=_CHAIN,
            quantity="slider_crank.rod_force"),
    Printed(equation="8", claim="radial force on the crank pin", statement="P*cos(phi + beta)/cos(beta)",
            letters=_CHAIN, quantity="slider_crank.radial_force"),
    Printed(equation="9", claim="tangential force on the crank pin", statement="P*sin(phi + beta)/cos(beta)",
            letters=_CHAIN, quantity="slider_crank.tangential_force"),
    Listed(equation="10", claim="gas force", statement="P_g = (p_g - p_0)*F_p", verdict="definition"),
    TextClaim(equation="text", claim="the resultant inertia force has a constant size", decide=claims.constant_size),
    TextClaim(equation="conclusion 3", claim="the inertia force always points along the rod",
              decide=claims.along_the_rod),
    TextClaim(equation="conclusion 2", claim="no side force presses the piston of a rodless engine on the cylinder",
              decide=claims.no_side_force),
)  # fmt: skip
