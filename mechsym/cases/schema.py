"""Which record each section of a case becomes. A section with a selector key has one record per named variant."""

from collections.abc import Iterable
from typing import Any

from mechsym.cycle.kinds import KINDS
from mechsym.errors import BadInput, shown, suggest
from mechsym.files import Json
from mechsym.quantities import load
from mechsym.quantities.records import Record

# section: "module:Record", or (selector key, {variant: "module:Record"}); modules are imported on first use
ENTRIES: dict[str, Any] = {
    "operation": "mechsym.cases.settings:Operation",
    "sizing": "mechsym.sizing.wants:Wants",
    "part_piston": "mechsym.sizing.wants:PistonPart",
    "part_cylinder": "mechsym.sizing.wants:CylinderPart",
    "part_gears": "mechsym.sizing.wants:GearPart",
    "part_crank": "mechsym.sizing.wants:CrankPart",
    "part_bearings": "mechsym.sizing.wants:BearingPart",
    "part_crosshead": "mechsym.sizing.slider_crank:CrossheadPart",
    "part_masses": "mechsym.sizing.wants:MassPart",
    "flywheel": "mechsym.cases.settings:FlywheelSettings",
    "trials": "mechsym.cases.settings:TrialSettings",
    "retune": "mechsym.cases.settings:RetuneSettings",
    "report": "mechsym.cases.settings:ReportSettings",
    "speeds": "mechsym.cases.settings:Speeds",
    "optimise": "mechsym.optimise.solver:Optimise",
    "chamber": "mechsym.cycle.chamber:ChamberParameters",
    "cycle": ("kind", {name: kind.cycle for name, kind in KINDS.items()}),
    "breathing": "mechsym.cycle.breathing.flow:Breathing",
    "gas_limits": "mechsym.cases.settings:GasLimits",
    "scavenging": "mechsym.cycle.breathing.flow:Scavenging",
    "boost": "mechsym.cycle.breathing.turbocharger:Boost",
    "stirling": "mechsym.cycle.kinds.stirling_second_order:StirlingLosses",
    "combustion": "mechsym.cycle.measured.combustion:Analysis",
    "measured": "mechsym.cycle.measured.diagram:BrakeMeasured",
    "gas": (
        "model",
        {"constant_gamma": "mechsym.cycle.heat:ConstantGamma", "nasa": "mechsym.cycle.heat:NasaMixture"},
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
    "blowdown": "mechsym.cycle.closed.model:Blowdown",
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
    "shaft": "mechsym.forces.mains:MainShaft",
    "startup": "mechsym.torsion.startup:StartUpClaim",
    "spring": (
        "law",
        {
            "air_gauge": "mechsym.hinge.springs.air:AirGauge",
            "air_absolute": "mechsym.hinge.springs.air:AirAbsolute",
            "air_thermal": "mechsym.hinge.springs.air_thermal:AirThermal",
            "coil": "mechsym.hinge.springs.coil:Coil",
        },
    ),
    "guide": "mechsym.hinge.choices:GuideParameters",
    "rollers": "mechsym.hinge.rollers:RollerParameters",
    "losses": "mechsym.hinge.rollers:HingeLosses",
    "codesign": "mechsym.codesign.settings:CoDesignSettings",
    "limits": "mechsym.hinge.choices:Limits",
    "friction": "mechsym.forces.friction:Friction",
    "rings": (
        "law",
        {
            "none": "mechsym.forces.friction:NoRings",
            "patton1989": "mechsym.forces.friction:Patton1989",
            "contact_pressure": "mechsym.forces.friction:ContactPressure",
        },
    ),
    "shaking": "mechsym.forces.loads:BalanceWanted",
    "comparison": "mechsym.forces.result:ComparisonSettings",
    "faces": "mechsym.mechanisms.closing:RodlessFaces",
    "closing": (
        "rule",
        {
            "crank_free_radially": "mechsym.mechanisms.closing:CrankFreeRadially",
            "stiffnesses": "mechsym.mechanisms.closing:Stiffnesses",
            "clearances": "mechsym.mechanisms.closing:Clearances",
        },
    ),
}


# sections whose keys are the mechanism's own letters: the function of mechsym.mechanisms that makes their record
LETTERS = {"parameters": "parameters_class", "inputs": "inputs_class", "start": "start_class", "motion": "motion_class"}


def sections() -> list[str]:
    """Names of all sections. Returns names: in the order of a case file."""
    return [*LETTERS, *ENTRIES]


def selector(section: str) -> str | None:
    """The key that chooses a section's variant. Returns key: None when the section has one record only."""
    entry = ENTRIES.get(section)
    return entry[0] if isinstance(entry, tuple) else None


def record(mechanism: str, section: str, table: Json) -> type[Record]:
    """The record class of a section. mechanism: decides `[parameters]`; table: raw values, for its selector."""
    if section in LETTERS:
        from mechsym import mechanisms

        return getattr(mechanisms, LETTERS[section])(mechanism)
    entry = ENTRIES[section]
    if isinstance(entry, tuple):
        key, variants = entry
        name = table.get(key)
        if not isinstance(name, str) or name not in variants:
            why = f"{key} = {shown(name)} is not known" if key in table else f"key {key} is missing"
            raise BadInput(why, suggest(str(name), variants))
        entry = variants[name]
    return load(entry)


def instead(key: str, fields: Iterable[str]) -> str:
    """What is allowed in place of a key that a section has not: a near one, another section's, the section's own."""
    if key in ENTRIES:
        return f"it is a section of its own: [{key}]"
    own, here = suggest(key, fields), {*fields}
    records = {name: entry[1].values() if isinstance(entry, tuple) else [entry] for name, entry in ENTRIES.items()}
    known = {name: [{*load(one).__dataclass_fields__} for one in all_of] for name, all_of in records.items()}
    homes = [f"[{name}]" for name, kinds in known.items() if here not in kinds and any(key in kind for kind in kinds)]
    return f"it is a key of {', '.join(homes)}; {own}" if homes and not own.startswith("did you mean") else own
