"""Which record each section of a case becomes. A section with a selector key has one record per named variant."""

import importlib
from typing import Any

from mechsym.errors import BadInput

# section: "module:Record", or (selector key, {variant: "module:Record"}); modules are imported on first use
_SECTIONS: dict[str, Any] = {
    "operation": "mechsym.cases.settings:Operation",
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
        if table.get(key) not in variants:
            raise BadInput(f"{key} = {table.get(key)!r} is not an option; options are {', '.join(variants)}")
        entry = variants[table[key]]
    module, _, name = entry.partition(":")
    return getattr(importlib.import_module(module), name)
