"""Source 002, Chmielewski et al. (2015): crankshaft and flywheel, as printed.

F in (1) and (3) is the rod force, tension positive. The models have no damping and no gas force.
"""

import mechsym.papers.chmielewski2015.claims as claims
from mechsym.audit.entries import Listed, Printed, TextClaim

_NO_GAS = {"F": 0.0, "c1": 0.0}
_LEVER = "(lam*sin(phi0)*cos(phi0) + sin(phi0)*sqrt(1 - lam**2*sin(phi0)**2))/sqrt(1 - lam**2*sin(phi0)**2)"
_TRUNCATED = "r*(phi0dd*(sin(phi0) + lam/2*sin(2*phi0)) + phi0d**2*(cos(phi0) + lam*cos(2*phi0)))"
_MIXED = f"I0*phi0dd + {_LEVER}*r*m0*({_TRUNCATED}) + k1*(phi0 - phi2)"

ENTRIES = (
    Listed(equation="text", claim="reduced inertias", statement="I_0 = I_w + m_s*r**2, I_2 = I_z",
           verdict="definition"),
    Printed(equation="1", claim="moments about the crankshaft", hold=_NO_GAS, letters={"F": "rod_force"},
            statement="M - I0*phi0dd - F*r*sin(phi0 + gamma0) - k1*(phi0 - phi2)",
            quantity="crankshaft_flywheel.residual_phi0",
            note="the sum is taken about the shaft, not about the top dead centre as the text says"),
    Printed(equation="2", claim="moments about the flywheel", statement="-I2*phi2dd + k1*(phi0 - phi2)", hold=_NO_GAS,
            quantity="crankshaft_flywheel.residual_phi2"),
    Printed(equation="3", claim="forces on the piston, solved for the rod force", statement="m0*x0dd/cos(gamma0)",
            hold=_NO_GAS, quantity="crankshaft_flywheel.rod_force"),
    Printed(equation="4", claim="theorem of sines, solved for the sine of the rod angle", statement="r/l*sin(phi0)",
            quantity="crankshaft_flywheel.sin_gamma0", note="the text calls the triangle equilateral"),
    Printed(equation="5", claim="cosine of the rod angle", statement="sqrt(1 - r**2/l**2*sin(phi0)**2)",
            quantity="crankshaft_flywheel.cos_gamma0"),
    Printed(equation="5", claim="cosine of the rod angle with lambda", statement="sqrt(1 - lam**2*sin(phi0)**2)",
            quantity="crankshaft_flywheel.cos_gamma0"),
    Printed(equation="6", claim="angular acceleration with the exact piston acceleration", hold=_NO_GAS,
            statement=f"phi0dd = M/I0 - {_LEVER}*r*m0/I0*x0dd - k1/I0*(phi0 - phi2) = 0",
            letters={"x0dd": "x0dd_solved"}, quantity="crankshaft_flywheel.acceleration_phi0"),
    Printed(equation="6", claim="with (11) put in, solved for the torque: the exact Lagrange equation",
            statement=_MIXED, hold=_NO_GAS, quantity="crankshaft_flywheel.driving_torque", turn=claims.steady,
            effect=claims.mixed_model_effect,
            note="the model that was simulated: exact transmission, truncated acceleration; no Lagrange equation, so "
                 "it has no energy of its own"),
    Printed(equation="6", claim="with (11) put in, solved for the torque: the Lagrange equation of (9)",
            statement=_MIXED, quantity="crankshaft_flywheel_truncated.driving_torque", turn=claims.steady,
            effect=claims.mixed_model_truncated_effect, note="no Lagrange equation of the truncated kinematics either"),
    Printed(equation="7", claim="piston travel", statement="r + l - r*cos(phi0) - l*cos(gamma0)",
            quantity="crankshaft_flywheel.x0"),
    Printed(equation="8", claim="piston travel by the crank angle", quantity="crankshaft_flywheel.x0",
            statement="r*((1 - cos(phi0)) + l/r*(1 - sqrt(1 - r**2/l**2*sin(phi0)**2)))"),
    Printed(equation="8", claim="piston travel with lambda", quantity="crankshaft_flywheel.x0",
            statement="r*((1 - cos(phi0)) + 1/lam*(1 - sqrt(1 - lam**2*sin(phi0)**2)))"),
    Printed(equation="9", claim="piston travel, two terms of the series", quantity="crankshaft_flywheel.x0",
            statement="r*((1 - cos(phi0)) + lam/4*(1 - cos(2*phi0)))"),
    Printed(equation="10", claim="piston velocity", statement="r*phi0d*(sin(phi0) + lam/2*sin(2*phi0))",
            quantity="crankshaft_flywheel.x0d"),
    Printed(equation="11", claim="piston acceleration", statement=_TRUNCATED, quantity="crankshaft_flywheel.x0dd"),
    TextClaim(equation="text", claim="the speed settles at 194 rad/s after 90 s", decide=claims.settles),
    TextClaim(equation="text", claim="a constant torque on a model without losses leads to a constant speed",
              decide=claims.constant_speed),
    TextClaim(equation="list of symbols", claim="the stiffness k1 has the unit N/m", decide=claims.unit_of_stiffness),
)  # fmt: skip
