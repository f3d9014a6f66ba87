"""Source 004, Nunes (2017), chapter 4: materials, piston, cylinder, gears, crankshaft, shafts, as printed.

Lengths in mm where the print gives plain numbers, N in rpm, FW the face width.
"""

from mechsym.audit.entries import Entry, Listed, Printed, TextClaim
from mechsym.papers.nunes2017 import claims_gears as gears
from mechsym.papers.nunes2017 import claims_loads as loads
from mechsym.papers.nunes2017 import claims_parts as parts

_GUPTA = "after Khurmi and Gupta"

PISTON: tuple[Entry, ...] = (
    Listed(equation="4.1", claim="allowable bending stress of a nitrided steel after AGMA",
           statement="0.7255*HB + 153.63", verdict="empirical", note="454.71 MPa with HB = 415"),
    Printed(equation="4.2", claim="thickness of the piston head, strength", statement="sqrt(3*p*B**2/(16*sigma_t))",
            quantity="engine_parts.head_strength"),
    Listed(equation="4.3", claim="thickness of the piston head, heat", statement="H/(12.56*k*(T_C - T_E))",
           verdict="empirical", note=_GUPTA),
    TextClaim(equation="4.3", claim="12.56 is the constant of an evenly heated disc", decide=parts.disc_constant),
    Listed(equation="4.4", claim="heat through the piston head", statement="C_heat*QHV*mdot_fuel", verdict="empirical",
           note="C_heat = 0.05 is a rule of thumb"),
    TextClaim(equation="4.4", claim="the thickness for heat is 13.74 mm", decide=parts.head_for_heat),
    Printed(equation="4.5", claim="diameter of the piston rod", statement="sqrt(4*F_t/(pi*sigma_f))",
            quantity="engine_parts.rod_diameter"),
    TextClaim(equation="4.5", claim="the rod has 26.29 mm with an allowable stress of 60 MPa",
              decide=parts.rod_diameter),
    Printed(equation="4.6", claim="radial thickness of a ring", statement="B*sqrt(3*p_w/sigma_t)",
            letters={"sigma_t": "sigma_ring"}, quantity="engine_parts.ring_thickness"),
    Listed(equation="4.7", claim="axial thickness of a ring", statement="B/(10*n_rings)", verdict="empirical"),
    Listed(equation="4.8", claim="depth of a groove", statement="t_1 + 0.4", verdict="empirical", note="in mm"),
    Listed(equation="4.9", claim="thickness of the barrel", statement="0.03*B + t_1 + 4.9", verdict="empirical",
           note="in mm"),
    Listed(equation="4.10", claim="height of the piston head", verdict="definition",
           statement="b_1 + n_rings*t_2 + n_rings*b_2"),
    Listed(equation="4.11", claim="mass of the piston", statement="V_piston*rho", verdict="definition"),
    TextClaim(equation="4.11", claim="the piston's 294.7 g are close to the moving mass of the model, 250 g",
              decide=loads.moving_mass),
    Listed(equation="4.12", claim="length of the rod", verdict="definition",
           statement="145 - S/4 - d_TDC/2 - t_H - ID_cap/2", note="in mm; S/4 = 2 r is the reach of the crank"),
    TextClaim(equation="4.12", claim="the rod is 88.6 mm long", decide=parts.rod_length),
)  # fmt: skip

CYLINDER: tuple[Entry, ...] = (
    Printed(equation="4.13", claim="thickness of the cylinder wall", statement="p*B/(2*sigma_c) + C_reboring",
            quantity="engine_parts.wall_thickness"),
    Listed(equation="4.14", claim="thickness of a dry liner", statement="0.03*B to 0.035*B", verdict="empirical"),
    Printed(equation="4.15", claim="distance of the piston heads at the top dead centre", statement="V_C/A_piston",
            quantity="engine_parts.d_TDC"),
    TextClaim(equation="4.15", claim="the heads stand 1.2 mm apart at the top dead centre", decide=parts.gap),
    Printed(equation="4.16", claim="distance of the piston heads at the bottom dead centre", statement="d_TDC + S",
            quantity="engine_parts.d_BDC"),
    Printed(equation="4.17", claim="least length of the cylinder", quantity="engine_parts.cylinder_length",
            statement="d_BDC + 2*(L_piston + 0.15*S/2)"),
    Printed(equation="4.17", claim="the same, written out", quantity="engine_parts.cylinder_length",
            statement="V_C/A_piston + 2*L_piston + 2.3*S/2"),
    TextClaim(equation="4.17", claim="the cylinder is 169.4 mm long, 170 mm are enough", decide=parts.cylinder_length),
    Printed(equation="4.18", claim="diameter of the bolts", statement="sqrt(B**2*p/(n_bolt*sigma_bolt))",
            quantity="engine_parts.bolt_core", note="it is the diameter of the core, not of the thread"),
    TextClaim(equation="4.18", claim="five bolts of 10 mm hold the cylinder", decide=parts.bolts),
)  # fmt: skip

GEARS: tuple[Entry, ...] = (
    TextClaim(equation="text 4.4.1", claim="modules of 1 and 2 were considered", decide=gears.modules),
    TextClaim(equation="table 4.9", claim="the centre distance of the gears is 26 mm (also table 4.13)",
              decide=gears.centre_distance),
    Listed(equation="4.19", claim="load distribution factor", statement="f(C_mf, C_mt)", verdict="definition"),
    Listed(equation="4.20", claim="load distribution factor of a spur gear", statement="C_mf", verdict="empirical",
           note="after AGMA"),
    Listed(equation="4.21", claim="face load distribution factor after AGMA", verdict="empirical",
           statement="1.0 + C_mc*(C_pf*C_pm + C_ma*C_e)",
           note="a property of the mesh; the thesis gives either member its own"),
    Listed(equation="4.22", claim="pinion proportion factor up to 25 mm after AGMA", verdict="empirical",
           statement="FW/(10*d_pitch) - 0.025",
           note="d_pitch is the pinion's; table 4.12 uses it for the ring at 52 mm"),
    Listed(equation="4.23", claim="pinion proportion factor above 25 mm after AGMA", verdict="empirical",
           statement="FW/(10*d_pitch) - 0.0375 + 0.000492*FW", note="d_pitch is the pinion's"),
    TextClaim(equation="table 4.10", claim="the load distribution factor is 1.2537 for the pinion, 1.1349 for the ring",
              decide=gears.load_distribution),
    Listed(equation="4.24", claim="mesh alignment factor of an extra precision unit after AGMA", verdict="empirical",
           statement="0.0380 + 0.000402*FW - 1.27e-7*FW**2"),
    Listed(equation="4.25", claim="dynamic factor after AGMA", statement="((C_kv + sqrt(200*v_t))/C_kv)**B_kv",
           verdict="empirical", note="200 stands for 196.85, the feet per minute of 1 m/s"),
    TextClaim(equation="4.25", claim="table 4.10 has the dynamic factor with the constant 200",
              decide=gears.dynamic_constant),
    Printed(equation="4.26", claim="pitch line velocity, of the pinion against its carrier",
            statement="pi*d_pitch*N/60", letters={"d_pitch": "d_pinion"}, quantity="engine_parts.mesh_speed",
            note="the carrier turns by omega and the planet by -omega", effect=gears.mesh_speed_effect),
    Printed(equation="4.26", claim="pitch line velocity, of the ring against the carrier",
            statement="pi*d_pitch*N/60", letters={"d_pitch": "2*d_pinion"}, quantity="engine_parts.mesh_speed"),
    Listed(equation="4.27", claim="exponent of the dynamic factor after AGMA", statement="0.25*(A_V - 5)**0.667",
           verdict="empirical"),
    Listed(equation="4.28", claim="constant of the dynamic factor after AGMA", statement="50 + 56*(1 - B_kv)",
           verdict="empirical"),
    Listed(equation="4.29", claim="largest pitch line velocity after AGMA", verdict="empirical",
           statement="(C_kv + (14 - A_V))**2/200", note="with 200 for 196.85 as (4.25)"),
    TextClaim(equation="table 4.10", claim="the dynamic factor at 8000 rpm is 1.1073 for the pinion, 1.1438 for the "
              "ring", decide=gears.dynamic_members),
    Printed(equation="4.30", claim="elastic coefficient, from the contact of two cylinders",
            statement="sqrt(1/(pi*((1 - nu_pinion**2)/E_pinion + (1 - nu_gear**2)/E_gear)))",
            quantity="engine_parts.Z_E"),
    TextClaim(equation="table 4.10", claim="Z_E is 1.8703e5 (N/mm^2)^0.5", decide=gears.elastic_coefficient),
    TextClaim(equation="table 4.11", claim="the ring's face width for contact follows from the ring's diameter in "
              "(2.78)", decide=gears.ring_contact),
    TextClaim(equation="table 4.12", claim="two gear sets of 39 mm are wide enough", decide=gears.face_width),
    TextClaim(equation="table 4.13", claim="the dedenda are 0.5 mm and 1.5 mm", decide=gears.dedenda),
)  # fmt: skip

CRANKSHAFT: tuple[Entry, ...] = (
    TextClaim(equation="text 4.5", claim="the largest force on the crankpin is 27410 N", decide=parts.crankpin_force),
    Printed(equation="4.31", claim="load of a main bearing", statement="F_t*d_force/d_bearing",
            quantity="engine_parts.F_bearing", note="holds for the force along the cylinder alone, at the dead centre"),
    Printed(equation="4.32", claim="diameter of the crankpin", quantity="engine_parts.crankpin_diameter",
            statement="(32*F_bearing*d_force/(pi*sigma_b))**(1/3)"),
    Listed(equation="4.33", claim="width of the crank web", statement="1.125*d_crankpin + 12.7", verdict="empirical",
           note=f"in mm; {_GUPTA}"),
    Printed(equation="4.34", claim="stress of the crank web", quantity="engine_parts.web_stress",
            statement="6*F_bearing*(d_force - l_crankpin/2 - t_crankweb/2)/(w_crankweb*t_crankweb**2)"
                      " + F_bearing/(w_crankweb*t_crankweb)"),
    TextClaim(equation="4.34", claim="the web's stress is 118.074 MPa", decide=parts.web_stress),
    Printed(equation="4.35", claim="diameter of the output shaft", statement="(Tq_max*16/(pi*sigma_S))**(1/3)",
            quantity="engine_parts.shaft_diameter"),
    TextClaim(equation="4.35", claim="the output shaft needs 7.82 mm, 8 mm are enough", decide=parts.output_shaft),
    Listed(equation="4.36", claim="moment of the rotating parts", statement="F*b = m*a*b", verdict="definition",
           note="a is the centripetal omega^2 b, not an angular acceleration; what must vanish is the sum of m b"),
    Listed(equation="4.37", claim="the same without the acceleration", statement="m*b", verdict="definition",
           note="the static unbalance; force and moment follow with omega^2"),
    TextClaim(equation="text 4.6.1", claim="the unbalance is 2783 g mm/s^2", decide=loads.unbalance_unit),
    TextClaim(equation="text 4.6.1", claim="the output shaft set balances the moving parts", decide=loads.balance),
)  # fmt: skip

BEARINGS: tuple[Entry, ...] = (
    TextClaim(equation="text 4.8", claim="two HK 2516 carry 30.2 kN, more than the largest load",
              decide=loads.rod_bearing_rating),
    TextClaim(equation="text 4.8", claim="the HN 1516 carry no more than the main bearing, half the piston's force",
              decide=loads.journal_load),
    TextClaim(equation="table 4.16", claim="the HN 1516 may run at the engine's speed", decide=loads.journal_speed),
    TextClaim(equation="text 5.1.2", claim="the engine has 13406.6 g", decide=loads.engine_mass),
    TextClaim(equation="text 6.1", claim="with maraging steel the face width is at most half", decide=gears.maraging),
    TextClaim(equation="chapter 4", claim="the parts as chosen hold", decide=loads.chosen_parts),
)  # fmt: skip

CHAPTER_4: tuple[Entry, ...] = (*PISTON, *CYLINDER, *GEARS, *CRANKSHAFT, *BEARINGS)
