"""Text of the case files that `mechsym new engine` fills; `<name>` is a number or a list."""

TRAIN = """
[parameters]   # one value for all, or one a cylinder; of throws one a throw. Cylinder 1 stands at the free end
throw = <throw>        # throw of each cylinder
bank = <bank>         # angle of each cylinder axis
phase = <phase>        # angle of each crank pin when the first cylinder is at its dead centre
firing = <firing>       # fires <order>; shaft angle within a cycle of <period> deg
r = "<r> mm"           # half the stroke
l1 = "<l1> mm"         # assumed: rod of <ratio> crank radii, its centre of mass a third from the crank pin
l2 = "<l2> mm"
m_rod = "<rod> kg"     # assumed: 900 kg/m3 of the cube of the bore
I_rod = "<I_rod> kg*m^2"   # assumed: a fifth of mass times length squared
m_piston = "<piston> kg"   # assumed: 780 kg/m3 of the cube of the bore; piston, rings and pin
m0 = "<m0> kg"         # assumed: throw with webs and counterweights, four pistons
u0 = <u0>   # counterweights balance the turning part of the rods
u_phase = <u_phase>    # against the pins
I0 = "<I0> kg*m^2"     # assumed: 11 piston masses at the crank radius
I_f = "<I_f> kg*m^2"   # assumed: flywheel, <heavy> piston masses at the crank radius
z = <z>   # assumed: cylinders 1.2 bores apart
<axes>k = "<k> N*m/rad"       # assumed: half the stiffness of a shaft of 0.6 bores between two throws
c = "<c> N*m*s/rad"    # assumed: 12 % of critical in the first mode, as a torsional damper gives; bare steel has 1 %

[friction]
mu_guide = 0.05               # assumed: piston skirt, mixed lubrication
mu_pin = 0.003                # assumed: full film
mu_main = 0.003               # assumed: full film
radius_piston_pin = "<pin> mm"   # assumed: an eighth of the bore
radius_crank_pin = "<r_crank> mm"    # assumed: 0.3 of the bore
radius_main = "<r_crank> mm"         # assumed: as the crank pin

[rings]
law = "contact_pressure"
mu = 0.05                     # assumed: between boundary and full film
heights = ["<ring> mm", "<ring> mm"]   # assumed
gas_shares = [0.8, 0.2]       # assumed: most of the pressure stands behind the first ring
elastic = "0.15 MPa"          # assumed
"""

HYPOCYCLOID = """
[parameters]
e = "<e> mm"           # crank throw, a quarter of the stroke
I1 = "<I1> kg*m^2"     # assumed: crank and shaft
u1 = 0.0               # crank not balanced yet: mechsym forces says which counterweight it wants
m2 = "<planet> kg"     # assumed: planet
I2 = "<I2> kg*m^2"     # assumed: planet about its centre
m3 = "<piston> kg"     # assumed: piston with its rod
alpha_n = "25 deg"     # pressure angle of the teeth

[flywheel]
inertia = "<flywheel> kg*m^2"   # assumed: 320 piston masses at half the stroke carry one cylinder over its compression

[speeds]               # for mechsym compare
lowest = "1000 rpm"
highest = "4000 rpm"
step = "500 rpm"

[friction]
mu_guide = 0.05               # assumed
mu_pin = 0.003                # assumed: rolling bearings
mu_main = 0.003               # assumed
mu_mesh = 0.06                # assumed: lubricated case-hardened teeth
module = "<module> mm"        # assumed: 26 teeth on the planet
radius_piston_pin = "<pin> mm"   # assumed: a quarter of the bore
radius_crank_pin = "<pin> mm"
radius_main = "<pin> mm"
"""

FOUR_STROKE = """
[chamber]
bore = "<bore> mm"
compression_ratio = <ratio>   # assumed: keeps the end gas from knocking
back_pressure = "101325 Pa"   # crankcase at the atmosphere

[cycle]                       # angles from firing dead centre
kind = "spark-ignition"
intake_pressure = "95 kPa"    # assumed: full throttle
intake_temperature = "320 K"  # assumed: warmed by the walls
inlet_closes = "-140 deg"     # assumed: 40 degrees after bottom dead centre
exhaust_opens = "130 deg"     # assumed: 50 degrees before bottom dead centre
ignition = "-10 deg"          # assumed: late, so that the end gas holds (knock below 1); best torque is near -22
octane = 98                   # assumed: premium petrol; knock is the integral that `mechsym cycle` shows
duration = "60 deg"           # assumed: usual at full load
wiebe_a = 5
wiebe_m = 2
air_fuel_ratio = 14.6
stoichiometric_ratio = 14.6   # petrol
heating_value = "43 MJ/kg"    # petrol
combustion_efficiency_max = 0.95   # assumed
latent_heat = "350 kJ/kg"     # petrol

[heat_transfer]
law = "annand"
wall_temperature = "450 K"    # assumed
a = 0.49                      # four-stroke
exponent = 0.7
radiation = 4.25e-9

[friction_pressure]           # what is left at the shaft: brake figures of mechsym cycle
law = "chen_flynn"

[load]
law = "propeller"             # takes the mean torque at the speed of operation
"""

TWO_STROKE_LARGE = """
[cycle]                              # angles from top dead centre
kind = "two-stroke-marine"           # algebraic cycle, closed for the mean pressure that is wanted
bore = "<bore> mm"
compression_ratio = 17               # assumed: long-stroke diesel
mean_indicated_pressure = "17 bar"   # assumed: near full load
p_s = "3.1 bar"                      # assumed: absolute scavenge pressure at that load
T_evc = "360 K"                      # assumed: scavenge air, warmed, with residual gas
evc = "-110 deg"                     # assumed: exhaust closes
soc = "0 deg"                        # assumed: combustion starts
duration = "45 deg"                  # assumed: slow engine
evo = "110 deg"                      # assumed: exhaust opens
spo = "140 deg"                      # assumed: scavenge ports open
n_c = 1.40                           # Shen et al. 2020: 1.391 to 1.416 over the load range
n_e = 1.30                           # Shen et al. 2020: 1.280 to 1.321 over the load range
a_p = 3.319                          # Shen et al. 2020, fitted set of the highest load (a_p, m_p, a_d, m_d, b)
m_p = 2.2
a_d = 12.71
m_d = 0.7247
b = 0.8023
R = "287 J/kg/K"                     # air
c_v = "900 J/kg/K"                   # assumed: mean of air and products; for the fuel estimate only
lhv = "42.7 MJ/kg"                   # ISO reference fuel (ISO 3046)
crank_side = "atmosphere"            # or "scavenge": p_s under the piston
p_back = "101325 Pa"

[load]
law = "propeller"                    # takes the mean torque at the speed of operation
"""

TWO_STROKE_SMALL = """
[cycle]                              # angles from inner dead centre; one piston sees its half of the chamber
kind = "two-stroke-marine"           # algebraic cycle, closed for the mean pressure that is wanted
bore = "<bore> mm"
compression_ratio = 16               # assumed
mean_indicated_pressure = "7 bar"    # assumed
p_s = "1.5 bar"                      # assumed: absolute scavenge pressure
T_evc = "360 K"                      # assumed
evc = "-115 deg"                     # assumed: exhaust closes
soc = "-3 deg"                       # assumed: combustion starts
duration = "45 deg"                  # assumed
evo = "112 deg"                      # assumed: exhaust opens
spo = "130 deg"                      # assumed: scavenge ports open
n_c = 1.36                           # assumed: small cylinders lose more heat
n_e = 1.30                           # assumed
a_p = 3.415                          # Shen et al. 2020, set of the lowest load, for want of a better one
m_p = 1.148
a_d = 23.8
m_d = 1.006
b = 0.6749
R = "287 J/kg/K"                     # air
c_v = "900 J/kg/K"                   # assumed
lhv = "42.7 MJ/kg"                   # ISO reference fuel (ISO 3046)
crank_side = "atmosphere"
p_back = "101325 Pa"

[load]
law = "propeller"                    # takes the mean torque at the speed of operation

[simulation]
turns = 30                           # assumed: from the speed of operation, until the vibration of the start is small
"""

CROSSHEAD = """
[parameters]           # masses: an engine of bore 0.3 m and stroke 1 m, scaled with bore^2 * stroke
r1 = "<r1> mm"         # shaft axis to the crank's centre of mass; r1 + r2 is half the stroke
r2 = "<r2> mm"         # from there to the crank pin
l1 = "<l1> mm"         # crank pin to the rod's centre of mass; l1 + l2 is the rod, 3.1 crank radii
l2 = "<l2> mm"         # from there to the crosshead pin
m1 = "<m1> kg"         # crank
m2 = "<m2> kg"         # rod
m3 = "<m3> kg"         # crosshead
m4 = "<m4> kg"         # piston rod
m5 = "<m5> kg"         # piston
I01 = "<I01> kg*m^2"   # crank about the shaft axis
IC2 = "<IC2> kg*m^2"   # rod about its centre of mass
g = "9.81 m/s^2"
axis_tilt = "90 deg"   # upright
"""

HINGE = """
[spring]                     # the spring of the hinge: gas behind a piston
law = "air_absolute"
A = "<area> m^2"             # assumed: 0.34 bore^2
H = "<H> mm"                 # assumed: free height as long as the stroke
p0 = "8 MPa"                 # excess pressure at free height: the first value to vary
n = 1.4                      # adiabatic: a turn is too short for the walls

[guide]
arrangement = "two_tracks"
start = "placed"
rho0 = "<rho0> mm"           # assumed: roller centre to shaft axis at free height, 0.8 strokes
z_margin = "<margin> mm"     # assumed: the spring keeps a little closing
shaft_ratio = 1              # the guide turns with the crank

[rollers]
radius = "<roller> mm"       # assumed: a tenth of the stroke
width = "<width> mm"         # assumed: for a contact pressure that hardened steel bears
plane_offset = "<offset> mm" # assumed: width, flange and clearance

[limits]
spring_pressure = "25 MPa"   # assumed: usual class of hydraulic accumulators
closing_share = 0.9          # assumed: a tenth of the gas column stays
pressure_angle = "30 deg"    # usual limit for a roller on a straight guide
profile_radius = "5 mm"      # assumed: a sharper ridge does not last
roller_reaction = "<force> kN"   # assumed: static rating of a bearing of the roller's size
hertz_stress = "1500 MPa"    # assumed: case-hardened steel (ISO 6336-5, MQ)

[friction]
mu_guide = 0.02              # assumed: crosshead shoes on white metal
mu_pin = 0.005               # assumed
mu_main = 0.003              # assumed
radius_piston_pin = "<pin> mm"   # assumed
radius_crank_pin = "<crank> mm"  # assumed
radius_main = "<crank> mm"       # assumed

[rings]
law = "contact_pressure"
mu = 0.05                    # assumed
heights = ["<ring> mm", "<ring> mm", "<ring> mm", "<ring> mm"]   # assumed
gas_shares = [0.7, 0.2, 0.08, 0.02]   # assumed
elastic = "0.1 MPa"          # assumed

[simulation]
turns = 20                   # assumed: enough to see whether a disturbance dies out
"""
