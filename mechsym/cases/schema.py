"""Which record each section of a case becomes. A section with a selector key has one record per named variant."""

import importlib
from typing import Any

from mechsym.errors import BadInput, shown, suggest

# section: "module:Record", or (selector key, {variant: "module:Record"}); modules are imported on first use
_SECTIONS: dict[str, Any] = {
    "operation": "mechsym.cases.settings:Operation",
    "sizing": "mechsym.sizing.wants:Wants",
    "part_piston": "mechsym.sizing.parts:PistonPart",
    "part_cylinder": "mechsym.sizing.parts:CylinderPart",
    "part_gears": "mechsym.sizing.parts:GearPart",
    "part_crank": "mechsym.sizing.parts:CrankPart",
    "part_bearings": "mechsym.sizing.parts:BearingPart",
    "part_masses": "mechsym.sizing.parts:MassPart",
    "flywheel": "mechsym.cases.settings:FlywheelSettings",
    "trials": "mechsym.cases.settings:TrialSettings",
    "retune": "mechsym.cases.settings:RetuneSettings",
    "speeds": "mechsym.cases.settings:Speeds",
    "optimise": "mechsym.optimise.problem:Optimise",
    "chamber": "mechsym.engine.chamber:ChamberParameters",
    "cycle": (
        "kind",
        {
            "two-stroke-marine": "mechsym.engine.two_stroke:TwoStrokeMarine",
            "two-stroke-zone": "mechsym.engine.two_stroke_zone:TwoStrokeZone",
            "diagram": "mechsym.engine.diagram:Diagram",
            "spark-ignition": "mechsym.engine.spark_ignition:SparkIgnition",
            "schmidt": "mechsym.engine.schmidt:Schmidt",
        },
    ),
    "combustion": "mechsym.engine.diagram_combustion:Analysis",
    "gas": (
        "model",
        {"constant_gamma": "mechsym.engine.gas:ConstantGamma", "nasa": "mechsym.engine.gas:NasaMixture"},
    ),
    "heat_transfer": (
        "law",
        {
            "annand": "mechsym.engine.heat:Annand",
            "woschni": "mechsym.engine.heat:Woschni",
            "hohenberg": "mechsym.engine.heat:Hohenberg",
            "none": "mechsym.engine.heat:Adiabatic",
        },
    ),
    "friction_pressure": (
        "law",
        {
            "none": "mechsym.engine.friction:NoFriction",
            "chen_flynn": "mechsym.engine.friction:ChenFlynn",
            "heywood": "mechsym.engine.friction:Heywood",
            "mechanism": "mechsym.engine.friction:MechanismFriction",
        },
    ),
    "load": (
        "law",
        {
            "constant": "mechsym.loads:ConstantLoad",
            "propeller": "mechsym.loads:PropellerLoad",
            "table": "mechsym.loads:TableLoad",
        },
    ),
    "drive": "mechsym.runs:StepTorque",
    "simulation": "mechsym.runs:Simulation",
    "startup": "mechsym.startup:StartUpClaim",
    "spring": (
        "law",
        {
            "air_gauge": "mechsym.springs:AirGauge",
            "air_absolute": "mechsym.springs:AirAbsolute",
            "coil": "mechsym.springs:Coil",
        },
    ),
    "guide": "mechsym.guide:GuideParameters",
    "rollers": "mechsym.rollers:RollerParameters",
    "limits": "mechsym.feasibility:Limits",
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
        },
    ),
}


def sections() -> list[str]:
    """Names of all sections.

    Returns
    -------
    names : list of str
        In the order of a case file
    """
    return ["parameters", *_SECTIONS]


def selector(section: str) -> str | None:
    """The key that chooses a section's variant.

    Parameters
    ----------
    section : str
        Name of the section

    Returns
    -------
    key : str or None
        None when the section has one record only
    """
    entry = _SECTIONS.get(section)
    return entry[0] if isinstance(entry, tuple) else None


def record(mechanism: str, section: str, table: dict[str, Any]) -> Any:
    """The record class of a section.

    Parameters
    ----------
    mechanism : str
        Name of the mechanism, which decides `[parameters]`
    section : str
        Name of the section
    table : dict
        The section's raw values, read for its selector

    Returns
    -------
    cls : type
        A frozen dataclass

    Raises
    ------
    KeyError
        No such section
    BadInput
        Unknown mechanism, or a missing or unknown variant
    """
    if section == "parameters":
        from mechsym.mechanisms import parameters_class

        return parameters_class(mechanism)
    entry = _SECTIONS[section]
    if isinstance(entry, tuple):
        key, variants = entry
        name = table.get(key)
        if not isinstance(name, str) or name not in variants:
            found = f"{key} = {shown(name)} is not known" if key in table else f"key {key} is missing"
            raise BadInput(f"{found}; {suggest(str(name), variants)}")
        entry = variants[name]
    module, _, name = entry.partition(":")
    return getattr(importlib.import_module(module), name)
