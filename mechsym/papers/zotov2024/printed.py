"""Source 000, Zotov et al. (2024): every numbered relation as printed, and the claims of its text.

P_i = m_i g, IC22 is the rod's inertia about its centre of mass, W the integral of M_h from 0. The weights act across
the cylinder axis. Roots and fraction bars that the machine-read text lost are read as in the shared notes.
"""

import mechsym.papers.zotov2024.claims as claims
from mechsym.audit.entries import Listed, Printed, TextClaim

_WEIGHTS = {"P1": "m1*g", "P2": "m2*g", "P3": "m3*g", "P4": "m4*g", "P5": "m5*g", "IC22": "IC2"}
_LYING = {"axis_tilt": 0.0}
_COS_PSI = "(1 - 0.25*lam**2 + 0.25*lam**2*cos(2*phi))"
_INERTIA = (
    "I01 + P2/g*((r1 + r2)**2*(sin(phi) - l1*lam/(2*(l1 + l2))*sin(2*phi))**2"
    " + l2**2*cos(phi)**2/(l1 + l2)**2*(r1 + r2)**2)"
    " + IC22*lam**2*cos(phi)**2/(1 - 1/4*lam**2 + 1/4*lam**2*cos(2*phi))**2"
    " + (P3 + P4 + P5)/g*(r1 + r2)**2*(sin(phi) + 1/2*lam*sin(2*phi))**2"
)
_SLOPE_RECIPROCATING = "1/g*2*(P3 + P4 + P5)*(r1 + r2)**2*(cos(phi) + lam*cos(2*phi))*(sin(phi) + 0.5*lam*sin(2*phi))"
_SLOPE_ROD = f"-2*IC22*lam**2*cos(phi)*sin(phi)/{_COS_PSI}**2 + IC22*lam**4*cos(phi)**2*sin(2*phi)/{_COS_PSI}**3"
_SLOPE = (
    f"{_SLOPE_ROD} + {_SLOPE_RECIPROCATING} + 1/g*P2*(r1 + r2)**2*(-2*l2**2*cos(phi)*sin(phi)/(l1 + l2)**2"
    " + 2*(cos(phi) - lam*l1*cos(2*phi)/(l1 + l2))*(sin(phi) - lam*l1*sin(2*phi)/(2*(l1 + l2))))"
)
_RATE_ROD = (
    f"-2*IC22*lam**2*cos(phi)*sin(phi)*phid/{_COS_PSI}**2 + IC22*lam**4*cos(phi)**2*sin(2*phi)*phid/{_COS_PSI}**3"
)
_RATE = (
    f"{_RATE_ROD} + 1/g*2*(P3 + P4 + P5)*(r1 + r2)**2*(sin(phi) + 0.5*lam*sin(2*phi))"
    "*(cos(phi)*phid + lam*cos(2*phi)*phid)"
    " + 1/g*P2*(r1 + r2)**2*(-2*l2**2*cos(phi)*sin(phi)*phid/(l1 + l2)**2"
    " + 2*(sin(phi) - lam*l1*sin(2*phi)/(2*(l1 + l2)))*(cos(phi)*phid - lam*l1*cos(2*phi)*phid/(l1 + l2)))"
)
_TRAVEL = "((r1 + r2)*sin(phi) + 0.5*(l1 + l2)*lam**2*sin(2*phi))"
_GRAVITY = f"P1*r1*cos(phi) + P2*l2*{_COS_PSI}*lam*cos(phi)/sqrt(1 - lam**2*sin(phi)**2)"
_BASE = "(H**(1 - n) - H**(-n)*(-1 + n)*W/(A*p0s))"
_SLOPE_GUIDE = f"-0.5*H**(-n)*(-1 + n)*M_h*{_BASE}**(n/(1 - n))/(A*(1 - n)*p0s)"

ENTRIES = (
    Listed(equation="1", claim="Lagrange's equation of the second kind", verdict="definition",
           statement="d/dt(dT/dphid) - dT/dphi = Q"),
    Printed(equation="2", claim="kinetic energy of the engine", statement="1/2*inertia*phid**2",
            quantity="crosshead.kinetic_energy"),
    Printed(equation="2", claim="reduced moment of inertia", statement=_INERTIA, letters=_WEIGHTS,
            quantity="crosshead.inertia", effect=claims.hinge_torque_effect,
            note="the same sign stands in (7) and (8), so it is no slip of the typesetter"),
    Printed(equation="3", claim="generalised force by virtual work, with its own variations",
            statement="F*dx_B - M_r + M_h - P1*r1*cos(phi) - P2*l2*cos(psi)*dpsi", hold=_LYING,
            letters=_WEIGHTS | {"dx_B": "dx_dphi", "dpsi": "dpsi_dphi"}, quantity="crosshead.generalized_force"),
    Printed(equation="3", claim="travel of the crosshead per crank angle",
            statement="(r1 + r2)*sin(phi) + 0.5*(l1 + l2)*lam**2*sin(2*phi)", quantity="crosshead.dx_dphi"),
    Printed(equation="3", claim="cosine of the rod angle", statement="1 - 0.25*lam**2 + 0.25*lam**2*cos(2*phi)",
            quantity="crosshead.cos_psi"),
    Printed(equation="3", claim="turn of the rod per crank angle",
            statement="lam*cos(phi)/sqrt(1 - lam**2*sin(phi)**2)", quantity="crosshead.dpsi_dphi"),
    Listed(equation="4", claim="work of the gas over a turn is the work of the load", verdict="definition",
           statement="int(F dx) = int(M_r1 dphi)"),
    Printed(equation="4", claim="torque of the piston force", statement=f"F*{_TRAVEL}", quantity="crosshead.gas_torque",
            turn=claims.gas_force, hold=_LYING),
    Listed(equation="5", claim="constant load torque", statement="M_r = int(M_r1, 0, 2 pi)/(2 pi)",
           verdict="definition"),
    Printed(equation="6", claim="generalised force, written out", letters=_WEIGHTS, hold=_LYING,
            statement=f"F*{_TRAVEL} - M_r + M_h - {_GRAVITY.replace(' + P2', ' - P2')}",
            quantity="crosshead.generalized_force", turn=claims.loads),
    Printed(equation="7", claim="equation of motion with the reduced inertia", hold=_LYING,
            statement="generalized_force - (inertia_rate*phid + inertia*phidd - 1/2*phid**2*dinertia_dphi)",
            quantity="crosshead.residual_phi"),
    Printed(equation="7", claim="time derivative of the reduced inertia", statement=_RATE, letters=_WEIGHTS,
            quantity="crosshead.inertia_rate", note="carries the sign of (2)"),
    Printed(equation="7", claim="derivative of the reduced inertia by the crank angle", statement=_SLOPE,
            letters=_WEIGHTS, quantity="crosshead.dinertia_dphi", note="carries the sign of (2)"),
    Printed(equation="8", claim="hinge torque for constant crank speed", letters=_WEIGHTS, hold=_LYING,
            statement=f"({_RATE})*phid - 0.5*phid**2*({_SLOPE}) - F*{_TRAVEL} + M_r + {_GRAVITY}",
            quantity="crosshead.hinge_torque", turn=claims.loads, note="carries the sign of (2) in four places"),
    Listed(equation="9", claim="work of the spring is the work of the hinge", verdict="definition",
           statement="-int(F_pn dz, 0, z) = int(M_h dphi, 0, phi)"),
    Printed(equation="9", claim="force of the air spring", statement="H**n*A*p0/(H - z)**n",
            quantity="guide.spring_force",
            note="p0 is called an excess pressure and used as an absolute one: exact for the printed law only"),
    Printed(equation="10", claim="work of the spring in closed form", quantity="guide.work",
            statement="-A*H**n*p0*(H - 2*rho0 + 2*rho)**(1 - n)/(n - 1) + A*p0*H/(n - 1)",
            note="the first line under the number (10) repeats (7)"),
    Printed(equation="11", claim="shape of the guide",
            statement="rho0 - 0.5*H + 0.5*(H**(1 - n) - (n - 1)/(A*H**n*p0)*W)**(1/(1 - n))",
            quantity="guide.rho_of_work"),
    Printed(equation="12", claim="torque of the guide at another pressure", statement="-F_pn*dz_dphi",
            letters={"F_pn": "A*p0*(H/(H - 2*rho0 + 2*rho_star))**n"}, quantity="guide.torque_at_pressure"),
    Printed(equation="13", claim="the same by the slope of the guide", statement="2*F_pn*drho_dphi",
            letters={"F_pn": "A*p0*(H/(H - 2*rho0 + 2*rho_star))**n"}, quantity="guide.torque_at_pressure"),
    Printed(equation="13", claim="slope of the guide", statement=_SLOPE_GUIDE, quantity="guide.drho_dphi"),
    Printed(equation="14", claim="torque of the guide at another pressure, written out",
            statement="-2*H**n*A*p0/(H - 2*(rho0 - rho_star))**n"
                      f"*(0.5*H**(-n)*(-1 + n)*M_h*{_BASE}**(n/(1 - n))/(A*(1 - n)*p0s))",
            quantity="guide.torque_at_pressure"),
    TextClaim(equation="text", claim="the integral of M_h over a turn is zero in both options",
              decide=claims.integral_vanishes),
    TextClaim(equation="text", claim="the largest moment of option b is about twice that of option a",
              decide=claims.about_twice),
    TextClaim(equation="text", claim="M_h is proportional to the square of the crank speed",
              decide=claims.proportional_to_square),
    TextClaim(equation="text", claim="the torque of a given guide is proportional to the pressure p0",
              decide=claims.proportional_to_pressure),
    TextClaim(equation="text", claim="raising p0 from 5 to 9.5 MPa gives the hinge needed at 142 rpm",
              decide=claims.pressure_ratio),
    TextClaim(equation="text", claim="the speed stays almost constant at 142 rpm with the guide cut for 89 rpm",
              decide=claims.almost_constant),
    TextClaim(equation="Fig. 5", claim="the guide compresses the spring everywhere",
              decide=claims.spring_compressed),
)  # fmt: skip
