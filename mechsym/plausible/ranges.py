"""Ranges by kind of value: beyond the hard one lies nonsense, beyond the usual one a doubt.

The usual ranges are those of reciprocating engines, from large marine two-strokes to models, after Heywood (1988),
Internal combustion engine fundamentals, chapters 2 and 15, and the data sheets of the materials; they are wide on
purpose. The hard ranges are a factor of about three to ten beyond, or a law of physics.
"""

import math

from mechsym.quantities import record


@record
class Usual:
    """One kind of value."""

    code: str  #: One word by which a case can accept a doubt
    keys: tuple[str, ...]  #: Names of the values, the last word of a dotted key
    unit: str  #: SI unit of the values, or the unit that a result's name says
    low: float = -math.inf  #: Usual [unit]
    high: float = math.inf  #: Usual [unit]
    lowest: float = -math.inf  #: Possible [unit]
    highest: float = math.inf  #: Possible [unit]
    why: str
    section: str = ""  #: Section of a case that it is meant for; empty for any


INPUTS = (
    Usual(code="intake_temperature", keys=("intake_temperature", "T_evc"), unit="K", low=230, high=500, lowest=100,
          highest=1000, why="absolute temperature of the charge; 15 degrees Celsius are 288.15 K"),
    Usual(code="wall_temperature", keys=("wall_temperature",), unit="K", low=300, high=700, lowest=150, highest=1500,
          why="absolute temperature of the chamber's wall; 77 degrees Celsius are 350 K"),
    Usual(code="hot_temperature", keys=("T_e",), unit="K", low=400, high=1300, lowest=100, highest=3000,
          why="absolute temperature of the hot space; metals bear about 1300 K"),
    Usual(code="cold_temperature", keys=("T_c",), unit="K", low=250, high=500, lowest=3, highest=1500,
          why="absolute temperature of the cold space"),
    Usual(code="charge_pressure", keys=("intake_pressure", "p_s", "inlet_pressure", "exhaust_pressure"), unit="Pa",
          low=2e4, high=1e6, lowest=1e3, highest=1e8, why="absolute pressure; one atmosphere is 101325 Pa"),
    Usual(code="heating_value", keys=("heating_value", "lhv"), unit="J/kg", low=1.5e7, high=1.25e8, lowest=1e6,
          highest=1.5e8, why="fuels lie between wood and hydrogen; petrol has 43.5 MJ/kg"),
    Usual(code="bore", keys=("bore",), unit="m", low=0.01, high=1.2, lowest=1e-3, highest=3.0,
          why="pistons of engines are 10 mm to 1 m wide"),
    Usual(code="gamma", keys=("gamma",), unit="-", low=1.15, high=1.67, lowest=1.01, highest=1.7,
          why="ratio of specific heats: 5/3 of a monatomic gas, 1.4 of air, above 1 of any"),
    Usual(code="gas_constant", keys=("gas_constant", "R"), unit="J/kg/K", low=150, high=4200, lowest=30, highest=4200,
          why="287 of air, 2077 of helium, 4124 of hydrogen"),
    Usual(code="compression_ratio", keys=("compression_ratio",), unit="-", low=3, high=30, lowest=1.0, highest=1000,
          why="spark ignition 7 to 14, diesel 12 to 24"),
    Usual(code="friction", keys=("mu_main", "mu_pin", "mu_guide", "mu_mesh", "mu", "seal_mu", "bearing_mu"), unit="-",
          low=0, high=0.3, lowest=0, highest=1.0, why="lubricated 0.001 to 0.1, dry metal up to about 0.3"),
    Usual(code="ignition", keys=("ignition",), unit="rad", low=math.radians(-60), high=math.radians(20),
          lowest=math.radians(-120), highest=math.radians(120),
          why="combustion starts 0 to 40 degrees before firing top dead centre; earlier is negative, '-20 deg'"),
    Usual(code="gravity", keys=("g",), unit="m/s^2", low=0, high=12, section="parameters",
          why="9.81 m/s^2 on the ground, 0 leaves gravity away"),
    Usual(code="tilt", keys=("axis_tilt",), unit="rad", low=-2 * math.pi, high=2 * math.pi, lowest=-4 * math.pi,
          highest=4 * math.pi, why="0 is a cylinder axis that lies, '90 deg' one that stands"),
    Usual(code="elastic_modulus", keys=("E", "youngs_modulus"), unit="Pa", low=5e9, high=7e11, lowest=1e9,
          highest=1.3e12, why="steel has 206 GPa, tungsten carbide 600 GPa"),
    Usual(code="polytropic_index", keys=("n",), unit="-", low=1.35, high=1.67, lowest=1.0, highest=1.7,
          section="spring", why="a gas spring faster than its heat exchange has n = gamma = 1.4; an index "
          "between 1 and gamma means heat through the wall, which costs work every turn"),
    Usual(code="octane", keys=("octane",), unit="-", low=80, high=100, lowest=60, highest=130,
          why="the law of the ignition delay was fitted to octane numbers of 80 to 100 (Douaud and Eyzat)"),
    Usual(code="porosity", keys=("porosity",), unit="-", low=0.6, high=0.83, lowest=0.3, highest=1.0,
          section="stirling", why="the laws of the screens hold at porosities of 0.6 to 0.83 (Kays and London)"),
    Usual(code="seal_gap", keys=("seal_gap",), unit="m", high=1e-4, section="stirling",
          why="a hundredth of a millimetre seals a piston, a tenth lets the gas through"),
    Usual(code="shuttle_gap", keys=("shuttle_gap",), unit="m", low=5e-5, high=5e-3, section="stirling",
          why="the law of the shuttle takes the heat through a narrow gap: some tenths of a millimetre"),
    Usual(code="burnt_share", keys=("a_p", "a_d", "wiebe_a"), unit="-", low=0.5, high=30, lowest=0.01, highest=1000,
          why="the share 1 - exp(-a) is burnt after the duration: 5 to 7 of a flame, fitted sets reach 24"),
    Usual(code="burn_form", keys=("m_p", "m_d", "wiebe_m"), unit="-", low=0, high=6, lowest=-1, highest=50,
          why="form of the burning rate: 0.5 to 1 of a diffusion flame, 2 of spark ignition"),
    Usual(code="burn_duration", keys=("duration",), unit="rad", low=math.radians(5), high=math.radians(180),
          lowest=math.radians(0.1), highest=math.radians(720), section="cycle",
          why="combustion takes 30 to 100 degrees of the crank"),
    Usual(code="back_pressure", keys=("p_back", "back_pressure", "pa"), unit="Pa", low=0, high=3e7, lowest=0,
          highest=1e9, why="absolute pressure behind the piston; one atmosphere is 101325 Pa"),
    Usual(code="filling_pressure", keys=("mean_pressure",), unit="Pa", low=5e4, high=3e7, lowest=1e3, highest=1e9,
          why="absolute pressure; Stirling engines are filled to 0.1 to 20 MPa"),
    Usual(code="spring_pressure", keys=("p0",), unit="Pa", low=5e4, high=5e7, lowest=0, highest=1e9, section="spring",
          why="gas springs are filled to 0.1 to 30 MPa"),
    Usual(code="heat_capacity", keys=("c_v",), unit="J/kg/K", low=500, high=12000, lowest=100, highest=2e4,
          why="718 of air, 3116 of helium, 10200 of hydrogen"),
    Usual(code="latent_heat", keys=("latent_heat",), unit="J/kg", low=0, high=2.6e6, lowest=0, highest=1e7,
          why="petrol takes 0.4 MJ/kg to evaporate, methanol 1.1, water 2.5"),
    Usual(code="strength", keys=("bolt_stress", "web_fatigue", "yield_strength", "shear_limit"), unit="Pa", low=1e7,
          high=3e9, lowest=1e5, highest=2e10, why="metals bear 20 MPa to 2 GPa"),
    Usual(code="bearing_pressure", keys=("pin_pressure", "crank_pin_pressure", "shoe_pressure"), unit="Pa", low=1e5,
          high=2e8, lowest=1e3, highest=1e10, why="shoes bear 0.6 MPa, pins in white metal 15 to 60 MPa"),
    Usual(code="viscosity", keys=("oil",), unit="Pa*s", low=1e-3, high=5, lowest=1e-6, highest=1e4,
          why="hot engine oil has 0.01 Pa*s, cold oil 1"),
    Usual(code="oil_film", keys=("film_start", "film_least"), unit="m", low=1e-7, high=1e-3, lowest=0, highest=0.1,
          why="oil films are a thousandth to a tenth of a millimetre thick"),
    Usual(code="ring_pressure", keys=("elastic",), unit="Pa", low=0, high=2e6, lowest=0, highest=1e9, section="rings",
          why="a ring presses with about 0.1 MPa of its own"),
    Usual(code="rolling_arm", keys=("rolling_arm",), unit="m", low=0, high=1e-3, lowest=0, highest=1,
          why="arm of rolling friction: some micrometres of steel on steel"),
    Usual(code="tube", keys=("heater_diameter", "cooler_diameter"), unit="m", low=1e-4, high=0.05, lowest=1e-6,
          highest=1, section="stirling", why="tubes of heat exchangers are some millimetres wide"),
    Usual(code="wire", keys=("wire",), unit="m", low=1e-5, high=1e-3, lowest=1e-7, highest=0.1, section="stirling",
          why="screens of regenerators have wires of some hundredths of a millimetre"),
    Usual(code="exchanger_length", keys=("heater_length", "cooler_length", "regenerator_length"), unit="m", low=2e-3,
          high=3, lowest=1e-5, highest=100, section="stirling", why="heat exchangers are a centimetre to a metre long"),
    Usual(code="gear_pressure_angle", keys=("alpha_n",), unit="rad", low=math.radians(10), high=math.radians(35),
          section="parameters", why="teeth of gears press at 14.5 to 25 degrees"),
    Usual(code="nusselt_factor", keys=("a",), unit="-", low=0.1, high=3, section="heat_transfer",
          why="Annand found 0.35 to 0.8"),
    Usual(code="convergence", keys=("difference_allowed",), unit="-", high=0.01, section="simulation",
          why="two runs that differ by more than a per cent have not converged"),
)  # fmt: skip


RESULTS = (
    Usual(code="peak_pressure", keys=("p_max_bar",), unit="bar", low=3, high=300, why="peak pressure of engines"),
    Usual(code="peak_pressure", keys=("p_max_mpa",), unit="MPa", low=0.3, high=30, why="peak pressure of engines"),
    Usual(code="mean_pressure", keys=("mep_bar",), unit="bar", high=40, why="mean effective pressure of engines"),
    Usual(code="mean_pressure", keys=("mep_kpa",), unit="kPa", high=4000, why="mean effective pressure of engines"),
    Usual(code="efficiency", keys=("efficiency", "mechanical_efficiency"), unit="-", low=0, high=0.999,
          why="an engine gives less than it takes"),
    Usual(code="power_balance", keys=("power_residual",), unit="-", low=-1e-6, high=1e-6,
          why="the power of all forces must balance"),
    Usual(code="energy_balance", keys=("energy_residual",), unit="-", low=-1e-5, high=1e-5,
          why="energy in, out and kept must balance"),
    Usual(code="mass_balance", keys=("mass_residual",), unit="-", low=-1e-5, high=1e-5,
          why="what flows in and does not flow out must be kept"),
    Usual(code="efficiency", keys=("brake_efficiency", "indicated_efficiency"), unit="-", low=0, high=0.999,
          why="an engine gives less than it takes"),
    Usual(code="gas_temperature", keys=("t_max_k",), unit="K", low=200, high=3500,
          why="flames of fuel in air reach about 2800 K, in oxygen 3500 K"),
    Usual(code="filling", keys=("volumetric_efficiency",), unit="-", low=0.1, high=1.3,
          why="a throttled engine fills a fifth of its swept volume, a well-tuned one a little more than all of it"),
    Usual(code="residual_gas", keys=("residual_gas",), unit="-", low=0, high=0.35,
          why="mixtures with more than about a third of burnt gas do not burn"),
    Usual(code="knock", keys=("knock",), unit="-", high=1,
          why="the end gas is ready to ignite before the flame reaches it (Livengood and Wu, Douaud and Eyzat)"),
    Usual(code="delivery", keys=("delivery_ratio",), unit="-", low=0.8, high=2.5,
          why="two-stroke engines are swept by 1 to 1.7 times their volume of air"),
    Usual(code="flow_share", keys=("flow_share",), unit="-", high=0.5,
          why="flow friction takes most of the work, the model needs it small: widen the exchangers, or slow down"),
    Usual(code="screen_reynolds", keys=("screen_reynolds",), unit="-", low=1, high=1000,
          why="the laws of the screens were measured at Reynolds numbers of 1 to 1000 (Kays and London)"),
    Usual(code="seal_reynolds", keys=("seal_reynolds",), unit="-", high=1000,
          why="the law of the leak is laminar: less flows in truth; take a narrower or longer seal"),
    Usual(code="compressor_ratio", keys=("compressor_ratio",), unit="-", low=1, high=6,
          why="one stage of a compressor reaches about 5.5"),
    Usual(code="condensation", keys=("dew_margin_k",), unit="K", low=0,
          why="the cooler brings the scavenge air below its dew point: water runs into the cylinders"),
    Usual(code="turbine_temperature", keys=("t_turbine_k",), unit="K", high=1323,
          why="turbines of turbochargers bear 1323 K (1050 degrees Celsius) at most"),
    Usual(code="twist", keys=("twist_peak",), unit="rad", low=-0.2, high=0.2,
          why="a section of a real shaft yields or breaks beyond about 0.2 rad"),
    Usual(code="speed_of_rotation", keys=("speed_max", "speed_mean", "speed_min"), unit="rad/s", low=-1e4, high=1e4,
          why="the fastest machines turn 100,000 times a minute"),
)  # fmt: skip


# how large a letter of any mechanism usually is, by its unit; the largest machines are ships' engines and presses
LARGEST = {
    "m": 100.0, "kg": 1e6, "kg*m": 1e6, "kg*m^2": 1e8, "rad": 1e5, "rad/s": 1e4, "m/s": 1e4, "N": 1e9, "N*m": 1e9,
    "N/m": 1e12, "N*m/rad": 1e12, "N*s/m": 1e10, "N*m*s/rad": 1e10, "m/s^2": 1e5,
}  # fmt: skip


# what several values of an engine say together; one number each, so without names of values
PROPORTIONS = (
    Usual(code="rod_ratio", keys=(), unit="-", low=1.8, high=8,
          why="rods of engines are 3 to 5 crank radii long"),
    Usual(code="piston_speed", keys=(), unit="m/s", high=30, highest=100, why="racing engines reach 27 m/s"),
    Usual(code="reciprocating_mass", keys=(), unit="kg/m^2", low=20, high=2e4, lowest=0, highest=1e6,
          why="mass that moves with a piston by its area: 100 of small petrol engines, 10,000 of marine ones"),
    Usual(code="spring_area", keys=(), unit="-", low=0.01, high=3, lowest=1e-4, highest=100,
          why="the spring of a hinge works against the gas: its piston is about as large as the engine's"),
    Usual(code="guide_size", keys=(), unit="-", low=0.05, high=10,
          why="a guide is about as large as the crank: its rollers run around it once a turn"),
    Usual(code="force_ratio", keys=(), unit="-", high=100,
          why="bearing forces are of the order of the gas force; check masses, speed and units"),
    Usual(code="efficiency_bound", keys=(), unit="-", high=1 + 1e-9,
          why="no cycle beats that of its compression ratio (Otto) or of its temperatures (Carnot)"),
    Usual(code="driven", keys=(), unit="J", low=0,
          why="the gas takes work: a heat pump, or a brake; in an engine the hot piston leads"),
    Usual(code="critical", keys=(), unit="-", high=5,
          why="the engine runs at a critical speed with little damping: move speed, inertias or stiffness, or damp it"),
    Usual(code="magnitude", keys=(), unit="-", low=-1, high=1,
          why="beyond the largest machines: a slip of the unit, or of the decimal point"),
    Usual(code="window", keys=(), unit="-", high=1, why="the run is shorter than what is summed up"),
    Usual(code="inertia", keys=(), unit="-", low=5e-3, high=5e3,
          why="cranks have about the inertia of what they move, flywheels up to a thousand times as much"),
    Usual(code="part_inertia", keys=(), unit="-", low=5e-3, high=1, highest=100,
          why="inertia about the centre of mass: a rod has a tenth to a fifth of its mass by its length squared"),
    Usual(code="unbalance", keys=(), unit="-", high=10, why="a counterweight balances about what moves on the crank"),
    Usual(code="mass_density", keys=(), unit="kg/m^3", low=1, high=1e5, highest=1e7,
          why="what moves is about as heavy as the metal that fits into bore and stroke"),
    Usual(code="shaft_frequency", keys=(), unit="rad/s", low=1, high=1e6,
          why="shafts of engines swing 10 to 1000 times a second"),
    Usual(code="shaft_damping", keys=(), unit="-", high=2, why="shafts keep swinging: a few per cent of the critical"),
    Usual(code="bearing_size", keys=(), unit="-", low=0.02, high=2, lowest=1e-4, highest=100,
          why="pins and bearings are a quarter to once as wide as the piston"),
    Usual(code="roller_size", keys=(), unit="-", low=0.02, high=5, lowest=1e-4, highest=100,
          why="rollers are a tenth to once as wide as the piston"),
    Usual(code="valve_size", keys=(), unit="-", low=0.01, high=3, lowest=1e-4, highest=100,
          why="valves and ports are a tenth to half as wide as the piston"),
    Usual(code="part_size", keys=(), unit="-", low=2e-3, high=20, lowest=1e-5, highest=1000,
          why="parts of an engine are a hundredth to a few times as long as its piston is wide"),
    Usual(code="dead_volume", keys=(), unit="-", low=5e-3, high=50, lowest=1e-5, highest=1e4,
          why="dead volumes of Stirling engines are a tenth to twice the swept volume"),
    Usual(code="buffer_volume", keys=(), unit="-", low=1, high=1000, lowest=0.5, highest=1e5,
          why="the piston leaves half its stroke free behind it at the least; crankcases hold some strokes"),
    Usual(code="conductance", keys=(), unit="-", high=0.3, highest=10,
          why="walls between hot and cold are thin: hundredths of a solid block of copper, 400 W/m/K, a stroke long"),
    Usual(code="spring_height", keys=(), unit="-", low=0.02, high=50, lowest=1e-4, highest=1e4,
          why="the spring of a hinge is about as high as the stroke"),
)  # fmt: skip
