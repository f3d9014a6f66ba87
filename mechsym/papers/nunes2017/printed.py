"""Source 004, Nunes (2017), chapters 2 and 3: performance, slider crank and geared hypocycloid, as printed.

S is the piston's distance from the shaft, r the crank radius (13 mm in the hypocycloid), l the length of the rod.
"""

from mechsym.audit.entries import Entry, Listed, Printed
from mechsym.papers.nunes2017.printed_chapter4 import CHAPTER_4
from mechsym.papers.nunes2017.printed_cycle import CLOSED_CYCLE, HEAT_MODELS, IDEAL_CYCLE
from mechsym.papers.nunes2017.printed_engine import MODEL, RESULTS

_CRANK = {"theta": "phi", "omega": "phid", "m_piston": "m", "S": "piston_position", "F_t": "total_force"}
_HYPO = {"r": "e", "omega": "thetad", "S": "piston_position", "F_t": "total_force"}
_STEADY = {"phidd": 0.0}
_ROOT = "(l**2 - r**2*sin(theta)**2)"
# what the mean of the torque and the gears of a massless planet at constant speed need
_MASSLESS = {"m2": 0.0, "I2": 0.0, "thetadd": 0.0}

PERFORMANCE: tuple[Entry, ...] = (
    Listed(equation="2.43", claim="compression ratio", statement="(V_displacement + V_c)/V_c", verdict="definition"),
    Listed(equation="2.44", claim="bore to stroke ratio", statement="B/S", verdict="definition"),
    Listed(equation="2.45", claim="torque", statement="F*b", verdict="definition"),
    Printed(equation="2.46", claim="power in kW", statement="2*pi*N/60*Tq", quantity="cylinder.power_kw",
            note="it is the power in W"),
    Printed(equation="2.46", claim="power by the angular velocity, in kW", statement="Tq*omega",
            quantity="cylinder.power_kw",
            note="it is the power in W"),
    Printed(equation="2.47", claim="horsepower", statement="1.34102209*P_kW", quantity="cylinder.horsepower"),
    Listed(equation="2.48", claim="indicated work per cycle", statement="int(p dV)", verdict="definition"),
    Printed(equation="2.49", claim="indicated power", statement="W_c*N/n_R", quantity="cylinder.power",
            note="N is in rpm in all other equations"),
    Printed(equation="2.50", claim="mean effective pressure", statement="P*n_R/(V_displaced*N/60)",
            letters={"P": "power"},
            quantity="cylinder.mep"),
    Printed(equation="2.51", claim="mean effective pressure by the torque", statement="6.28*n_R*Tq/V_displaced",
            quantity="cylinder.mep"),
    Printed(equation="2.52", claim="specific fuel consumption", statement="mdot_fuel/P_kW", letters={"P_kW": "power"},
            quantity="cylinder.sfc", note="in kg/J with the power in W"),
    Printed(equation="2.53", claim="efficiency by the work of a cycle", statement="W_c/(m_fuel*QHV)",
            quantity="cylinder.efficiency"),
    Printed(equation="2.53", claim="efficiency by the power", statement="P/(m_fuel*QHV)", letters={"P": "power"},
            quantity="cylinder.efficiency", note="the fuel flow is needed, not the fuel of a cycle"),
    Printed(equation="2.53", claim="efficiency by the consumption", statement="1/(sfc*QHV)",
            quantity="cylinder.efficiency"),
    Listed(equation="2.54", claim="air to fuel ratio", statement="mdot_air/mdot_fuel", verdict="definition"),
    Listed(equation="2.55", claim="relative air to fuel ratio", statement="AFR/AFR_stoich", verdict="definition"),
    Listed(equation="2.56", claim="combustion efficiency", verdict="empirical",
           statement="eta_cmax*(-1.6082 + 4.6509*lam - 2.0764*lam**2)"),
)  # fmt: skip

SLIDER_CRANK: tuple[Entry, ...] = (
    Printed(equation="2.57", claim="piston position", letters=_CRANK, statement=f"r*cos(theta) + {_ROOT}**(1/2)",
            quantity="opposed_slider_crank.piston_position"),
    Printed(equation="2.58", claim="piston velocity", letters=_CRANK, quantity="opposed_slider_crank.piston_velocity",
            statement=f"(-r*sin(theta) - r**2*cos(theta)*sin(theta)/{_ROOT}**(1/2))*omega"),
    Printed(equation="2.59", claim="piston acceleration", letters=_CRANK,
            quantity="opposed_slider_crank.piston_acceleration_outwards",
            statement=f"(-r*cos(theta) - r**2*cos(theta)**2/{_ROOT}**(1/2) + r**2*sin(theta)**2/{_ROOT}**(1/2)"
                      f" - r**4*cos(theta)**2*sin(theta)**2/{_ROOT}**(3/2))*omega**2"),
    Printed(equation="2.60", claim="volume of the chamber between two opposed pistons", letters=_CRANK,
            statement="A_piston*(l + r - S) + V_c", quantity="opposed_slider_crank.chamber_volume",
            note="right for one piston; with the printed V_c it gives a compression ratio of 5.5 for 10"),
    Printed(equation="2.61", claim="clearance volume", statement="V_displacement/(CR - 1)",
            quantity="opposed_slider_crank.clearance_volume"),
    Printed(equation="2.62", claim="force on the piston with (2.63) and (2.64)",
            letters=_CRANK | {"a": "piston_acceleration_outwards"},
            statement="m_piston*a + p*A_piston", quantity="opposed_slider_crank.force_on_piston"),
    Listed(equation="2.63", claim="inertia force", statement="m_piston*a", verdict="definition",
           note="a is negative at the top dead centre, so the sum (2.62) is right"),
    Listed(equation="2.64", claim="pressure force", statement="p*A_piston", verdict="definition",
           note="absolute pressure is used as net pressure: 1.1 per cent of the force, nothing of the mean torque"),
    Printed(equation="2.65", claim="torque", letters=_CRANK, statement="F_t/cos(beta)*r*sin(theta + beta)",
            quantity="opposed_slider_crank.torque"),
    Listed(equation="2.66", claim="mean torque", statement="sum(Tq)/theta_total", verdict="definition",
           note="evaluated with 721 points for 720 degrees: 0.14 per cent low"),
    Printed(equation="2.67", claim="rod angle", letters=_CRANK, statement="asin(r*sin(theta)/l)",
            quantity="opposed_slider_crank.beta"),
)  # fmt: skip

HYPOCYCLOID: tuple[Entry, ...] = (
    Printed(equation="2.68", claim="piston position", letters=_HYPO, statement="2*r*cos(theta) + l",
            quantity="opposed_hypocycloid.piston_position"),
    Printed(equation="2.69", claim="piston velocity", letters=_HYPO, statement="(-2*r*sin(theta))*omega",
            quantity="opposed_hypocycloid.piston_velocity"),
    Printed(equation="2.70", claim="piston acceleration", letters=_HYPO, statement="(-2*r*cos(theta))*omega**2",
            quantity="opposed_hypocycloid.piston_acceleration_outwards"),
    Printed(equation="2.71", claim="volume of the chamber between two opposed pistons", letters=_HYPO,
            statement="A_piston*(l + 2*r - S) + V_c", quantity="opposed_hypocycloid.chamber_volume",
            note="right for one piston; with the printed V_c it gives a compression ratio of 5.5 for 10"),
    Printed(equation="2.72", claim="clearance volume", statement="V_displacement/(CR - 1)",
            quantity="opposed_hypocycloid.clearance_volume"),
    Printed(equation="2.73", claim="torque", letters=_HYPO, statement="F_t/cos(theta)*r*sin(2*theta)", hold=_MASSLESS,
            quantity="opposed_hypocycloid.piston_torque",
            note="0/0 at 90 and 270 degrees; 2 r F_t sin(theta) is the same"),
    Listed(equation="2.74", claim="mean torque", statement="sum(Tq)/theta_total", verdict="definition",
           note="as (2.66)"),
    Printed(equation="2.75", claim="tangential tooth load", letters=_HYPO, statement="F_t*sin(theta)", hold=_MASSLESS,
            quantity="opposed_hypocycloid.tooth_force"),
    Listed(equation="2.76", claim="bending stress after AGMA", verdict="empirical",
           statement="F_gt*K_O*K_V*K_S/(FW*m_n)*K_m*K_B/J"),
    Listed(equation="2.77", claim="allowable bending stress after AGMA", verdict="empirical",
           statement="sigma_FP*Y_N/(SF*K_T*K_R)"),
    Listed(equation="2.78", claim="contact stress after AGMA", verdict="empirical",
           statement="Z_E*sqrt(F_gt*K_O*K_V*K_S*K_m/(d_pitch*FW)*C_f/I)",
           note="d_pitch is the pinion's for both members; the thesis used the ring's for the ring"),
    Listed(equation="2.79", claim="allowable contact stress after AGMA", verdict="empirical",
           statement="sigma_HP*Z_N*C_H/(SH*K_T*K_R)"),
)  # fmt: skip

ENTRIES: tuple[Entry, ...] = (
    *IDEAL_CYCLE,
    *HEAT_MODELS,
    *PERFORMANCE,
    *SLIDER_CRANK,
    *HYPOCYCLOID,
    *CLOSED_CYCLE,
    *MODEL,
    *CHAPTER_4,
    *RESULTS,
)
