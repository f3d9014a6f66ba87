"""Which record each section of a case becomes. A section with a selector key has one record per named variant."""

from typing import Any

from mechsym.cycle.kinds import KINDS
from mechsym.errors import BadInput, shown, suggest
from mechsym.quantities import load

# section: "module:Record", or (selector key, {variant: "module:Record"}); modules are imported on first use
ENTRIES: dict[str, Any] = {
    "operation": "mechsym.cases.settings:Operation",
    "sizing": "mechsym.sizing.wants:Wants",
    "part_piston": "mechsym.sizing.parts.records:PistonPart",
    "part_cylinder": "mechsym.sizing.parts.records:CylinderPart",
    "part_gears": "mechsym.sizing.parts.records:GearPart",
    "part_crank": "mechsym.sizing.parts.records:CrankPart",
    "part_bearings": "mechsym.sizing.parts.records:BearingPart",
    "part_crosshead": "mechsym.sizing.crosshead:CrossheadPart",
    "part_masses": "mechsym.sizing.parts.records:MassPart",
    "flywheel": "mechsym.cases.settings:FlywheelSettings",
    "trials": "mechsym.cases.settings:TrialSettings",
    "retune": "mechsym.cases.settings:RetuneSettings",
    "report": "mechsym.cases.settings:ReportSettings",
    "speeds": "mechsym.cases.settings:Speeds",
    "optimise": "mechsym.optimise.problem:Optimise",
    "chamber": "mechsym.cycle.chamber:ChamberParameters",
    "cycle": ("kind", {name: kind.cycle for name, kind in KINDS.items()}),
    "breathing": "mechsym.cycle.breathing.records:Breathing",
    "gas_limits": "mechsym.cases.gas_limits:GasLimits",
    "scavenging": "mechsym.cycle.breathing.scavenging:Scavenging",
    "boost": "mechsym.cycle.breathing.turbocharger:Boost",
    "stirling": "mechsym.cycle.kinds.stirling_second_order:StirlingLosses",
    "combustion": "mechsym.cycle.measured.combustion:Analysis",
    "measured": "mechsym.cycle.measured.diagram:BrakeMeasured",
    "gas": (
        "model",
        {"constant_gamma": "mechsym.cycle.mixture:ConstantGamma", "nasa": "mechsym.cycle.mixture:NasaMixture"},
    ),
    "heat_transfer": (
        "law",
        {
            "annand": "mechsym.cycle.heat:Annand",
            "woschni": "mechsym.cycle.heat:Woschni",
            "hohenberg": "mechsym.cycle.heat:Hohenberg",
            "none": "mechsym.cycle.heat:Adiabatic",
        },
    ),
    "friction_pressure": (
        "law",
        {
            "none": "mechsym.cycle.friction:NoFriction",
            "chen_flynn": "mechsym.cycle.friction:ChenFlynn",
            "heywood": "mechsym.cycle.friction:Heywood",
            "mechanism": "mechsym.cycle.friction:MechanismFriction",
        },
    ),
    "load": (
        "law",
        {
            "constant": "mechsym.machine.loads:ConstantLoad",
            "propeller": "mechsym.machine.loads:PropellerLoad",
            "table": "mechsym.machine.loads:TableLoad",
        },
    ),
    "drive": "mechsym.simulate.settings:StepTorque",
    "torque": "mechsym.machine.torque_curve:TorqueCurve",
    "simulation": "mechsym.simulate.settings:Simulation",
    "shaft": "mechsym.torsion.train:ShaftLimits",
    "startup": "mechsym.torsion.startup:StartUpClaim",
    "spring": (
        "law",
        {
            "air_gauge": "mechsym.hinge.springs:AirGauge",
            "air_absolute": "mechsym.hinge.springs:AirAbsolute",
            "air_thermal": "mechsym.hinge.thermal:AirThermal",
            "coil": "mechsym.hinge.springs:Coil",
        },
    ),
    "guide": "mechsym.hinge.choices:GuideParameters",
    "rollers": "mechsym.hinge.rollers:RollerParameters",
    "losses": "mechsym.hinge.losses:HingeLosses",
    "codesign": "mechsym.codesign.settings:CoDesignSettings",
    "limits": "mechsym.hinge.choices:Limits",
    "friction": "mechsym.forces.friction:Friction",
    "rings": (
        "law",
        {
            "none": "mechsym.forces.rings:NoRings",
            "patton1989": "mechsym.forces.rings:Patton1989",
            "contact_pressure": "mechsym.forces.rings:ContactPressure",
        },
    ),
    "shaking": "mechsym.forces.shaking:BalanceWanted",
    "comparison": "mechsym.forces.comparison:ComparisonSettings",
    "faces": "mechsym.mechanisms.rodless_faces:RodlessFaces",
    "closing": (
        "rule",
        {
            "crank_free_radially": "mechsym.mechanisms.rodless:CrankFreeRadially",
            "stiffnesses": "mechsym.mechanisms.rodless:Stiffnesses",
            "clearances": "mechsym.mechanisms.rodless_clearance:Clearances",
        },
    ),
}


# sections whose keys are the mechanism's own letters: the function of mechsym.mechanisms that makes their record
LETTERS = {"parameters": "parameters_class", "inputs": "inputs_class", "start": "start_class"}


def sections() -> list[str]:
    """Names of all sections.

    Returns
    -------
    names : list of str
        In the order of a case file
    """
    return [*LETTERS, *ENTRIES]


def selector(section: str) -> str | None:
    """The key that chooses a section's variant.

    Returns
    -------
    key : str or None
        None when the section has one record only
    """
    entry = ENTRIES.get(section)
    return entry[0] if isinstance(entry, tuple) else None


def record(mechanism: str, section: str, table: dict[str, Any]) -> Any:
    """The record class of a section.

    Parameters
    ----------
    mechanism : str
        Name of the mechanism, which decides `[parameters]`
    table : dict
        The section's raw values, read for its selector
    """
    if section in LETTERS:
        from mechsym import mechanisms

        return getattr(mechanisms, LETTERS[section])(mechanism)
    entry = ENTRIES[section]
    if isinstance(entry, tuple):
        key, variants = entry
        name = table.get(key)
        if not isinstance(name, str) or name not in variants:
            found = f"{key} = {shown(name)} is not known" if key in table else f"key {key} is missing"
            raise BadInput(f"{found}; {suggest(str(name), variants)}")
        entry = variants[name]
    return load(entry)
