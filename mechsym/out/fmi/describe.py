"""modelDescription.xml of a block for FMI 2.0 and 3.0, and the description of its sources.

Value references run through time, states, rates, inputs, parameters, outputs and event indicators, as in c/core.h.
"""

from xml.etree import ElementTree as xml

from mechsym.out.block import Block, Port
from mechsym.quantities import dimension, record

_LICENSE = "sources: as mechsym (MIT); FMI headers: 2-Clause BSD"


@record
class Variable:
    """A variable of the description; `kind` is one of time, state, rate, input, parameter, output, indicator."""

    reference: int
    port: Port
    kind: str
    of: int = -1  #: reference of the state whose rate this is


def variables(block: Block) -> list[Variable]:
    """All variables in the order of their references."""
    rows = [(Port(name="time", unit="s"), "time", -1)]
    rows += [(s, "state", -1) for s in block.states]
    for i, s in enumerate(block.states):
        unit = f"{s.unit[:-2]}/s^2" if s.unit.endswith("/s") else f"{s.unit}/s"
        rows.append((Port(name=f"der({s.name})", unit=unit), "rate", 1 + i))
    rows += [(port, "input", -1) for port in block.inputs]
    rows += [(port, "parameter", -1) for port in block.parameters]
    rows += [(port, "output", -1) for port in block.outputs]
    rows += [(port, "indicator", -1) for port in _indicators(block)]
    return [Variable(reference=i, port=port, kind=kind, of=of) for i, (port, kind, of) in enumerate(rows)]


def _indicators(block: Block) -> list[Port]:
    kinks = [(k.coordinate, a) for k in block.kinks for a in k.angles]
    ports = [
        Port(name=f"kink_{i}", unit="-", about=f"0 where {q} stands at {a:.6g} rad")
        for i, (q, a) in enumerate(kinks, 1)
    ]
    units = {s.name: s.unit for s in block.states}
    return ports + [Port(name=f"to_{s.name}", unit=units[s.of], about=f"ends the run: {s.name}") for s in block.stops]


def identifier(name: str) -> str:
    """A C identifier for a name."""
    text = "".join(c if c.isalnum() and c.isascii() else "_" for c in name)
    return text if text[:1].isalpha() else f"m_{text}"


def description(block: Block, version: int, token: str, sources: list[str], tool: str) -> str:
    """The text of modelDescription.xml."""
    make = _second if version == 2 else _third
    root = make(block, token, sources)
    root.set("generationTool", tool)
    xml.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + xml.tostring(root, encoding="unicode") + "\n"


def _smooth(block: Block) -> str:
    return "true" if block.states else "false"  # what has no states is a controller, which has no derivatives


def _boxed(root: xml.Element, block: Block, rows: list[Variable]) -> xml.Element:
    """Units, logs and experiment of a description; the box of its variables behind them."""
    box = xml.SubElement(root, "UnitDefinitions")
    for unit in sorted({v.port.unit for v in rows} - {"-", ""}):
        powers = dict(zip(("kg", "m", "s", "K"), dimension(unit.replace("(", "").replace("*rad)", "/rad)").strip(")")),
                          strict=True))  # fmt: skip
        powers["rad"] = int(unit in ("rad", "rad/s", "rad/s^2"))
        xml.SubElement(xml.SubElement(box, "Unit", name=unit), "BaseUnit", {k: str(v) for k, v in powers.items() if v})
    xml.SubElement(xml.SubElement(root, "LogCategories"), "Category", name="logStatusError")
    xml.SubElement(root, "DefaultExperiment", startTime="0", stopTime=repr(block.t_end), tolerance="1e-10")
    return xml.SubElement(root, "ModelVariables")


_FLAGS_2 = {
    "time": {"causality": "independent", "variability": "continuous"},
    "state": {"causality": "local", "variability": "continuous", "initial": "exact"},
    "rate": {"causality": "local", "variability": "continuous", "initial": "calculated"},
    "input": {"causality": "input", "variability": "continuous"},
    "parameter": {"causality": "parameter", "variability": "tunable", "initial": "exact"},
    "output": {"causality": "output", "variability": "continuous", "initial": "calculated"},
}


def _second(block: Block, token: str, sources: list[str]) -> xml.Element:
    rows = [v for v in variables(block) if v.kind != "indicator"]
    root = xml.Element(
        "fmiModelDescription", fmiVersion="2.0", modelName=block.name, guid=token, description=block.about,
        license=_LICENSE, variableNamingConvention="structured",
        numberOfEventIndicators=str(len(_indicators(block))),
    )  # fmt: skip
    can = {"modelIdentifier": identifier(block.name), "canGetAndSetFMUstate": "true",
           "canSerializeFMUstate": "true", "providesDirectionalDerivative": _smooth(block)}  # fmt: skip
    kinds: dict[str, dict[str, str]] = {"ModelExchange": {}} if block.states else {}
    for kind, more in (kinds | {"CoSimulation": {"canHandleVariableCommunicationStepSize": "true"}}).items():
        files = xml.SubElement(xml.SubElement(root, kind, can | more), "SourceFiles")
        for name in sources:
            xml.SubElement(files, "File", name=name)
    box = _boxed(root, block, rows)
    for v in rows:
        head = {"name": v.port.name, "valueReference": str(v.reference)} | _about(v) | _FLAGS_2[v.kind]
        real = xml.SubElement(xml.SubElement(box, "ScalarVariable", head), "Real", _unit(v) | _start(v))
        if v.of >= 0:
            real.set("derivative", str(v.of + 1))
    _structure_2(root, rows)
    return root


def _structure_2(root: xml.Element, rows: list[Variable]) -> None:
    structure = xml.SubElement(root, "ModelStructure")
    moving = " ".join(str(v.reference + 1) for v in rows if v.kind in ("state", "input"))
    given = " ".join(str(v.reference + 1) for v in rows if v.kind in ("state", "input", "parameter"))
    boxes = (
        ("Outputs", ("output",), moving),
        ("Derivatives", ("rate",), moving),
        ("InitialUnknowns", ("output", "rate"), given),
    )
    for title, kinds, known in boxes:
        entries = sorted((v for v in rows if v.kind in kinds), key=lambda v: v.reference)
        if not entries:
            continue
        box = xml.SubElement(structure, title)
        for v in entries:
            xml.SubElement(box, "Unknown", index=str(v.reference + 1), dependencies=known)


def _about(v: Variable) -> dict[str, str]:
    return {"description": v.port.about} if v.port.about else {}


def _unit(v: Variable) -> dict[str, str]:
    return {} if v.port.unit in ("-", "") else {"unit": v.port.unit}


def _start(v: Variable) -> dict[str, str]:
    return {"start": repr(float(v.port.start))} if v.kind in ("state", "input", "parameter") else {}


_FLAGS_3 = _FLAGS_2 | {
    "state": _FLAGS_2["state"] | {"causality": "output"},
    "indicator": {"causality": "local", "variability": "continuous", "initial": "calculated"},
}


def _third(block: Block, token: str, sources: list[str]) -> xml.Element:
    rows = variables(block)
    root = xml.Element(
        "fmiModelDescription", fmiVersion="3.0", modelName=block.name, instantiationToken=token,
        description=block.about, license=_LICENSE, variableNamingConvention="structured",
    )  # fmt: skip
    can = {"modelIdentifier": identifier(block.name), "canGetAndSetFMUState": "true",
           "canSerializeFMUState": "true", "providesDirectionalDerivatives": _smooth(block)}  # fmt: skip
    if block.states:
        xml.SubElement(root, "ModelExchange", can)
    xml.SubElement(root, "CoSimulation", can | {"canHandleVariableCommunicationStepSize": "true"})
    box = _boxed(root, block, rows)
    for v in rows:
        head = {"name": v.port.name, "valueReference": str(v.reference)} | _about(v) | _FLAGS_3[v.kind]
        more = {"derivative": str(v.of)} if v.of >= 0 else {}
        xml.SubElement(box, "Float64", head | _unit(v) | _start(v) | more)
    _structure_3(root, rows)
    return root


def _structure_3(root: xml.Element, rows: list[Variable]) -> None:
    structure = xml.SubElement(root, "ModelStructure")
    states = " ".join(str(v.reference) for v in rows if v.kind == "state")
    moving = " ".join(str(v.reference) for v in rows if v.kind in ("state", "input"))
    given = " ".join(str(v.reference) for v in rows if v.kind in ("state", "input", "parameter"))

    def entry(title: str, v: Variable, known: str) -> None:
        xml.SubElement(structure, title, valueReference=str(v.reference), dependencies=known)

    for v in rows:
        if v.kind in ("output", "state"):
            entry("Output", v, moving if v.kind == "output" else str(v.reference))
    for v in rows:
        if v.kind == "rate":
            entry("ContinuousStateDerivative", v, moving)
    for v in rows:
        if v.kind in ("output", "rate"):
            entry("InitialUnknown", v, given)
    for v in rows:
        if v.kind == "indicator":
            entry("EventIndicator", v, states)


def build_description(block: Block, sources: list[str]) -> str:
    """sources/buildDescription.xml of FMI 3.0."""
    root = xml.Element("fmiBuildDescription", fmiVersion="3.0")
    configuration = xml.SubElement(root, "BuildConfiguration", modelIdentifier=identifier(block.name))
    files = xml.SubElement(configuration, "SourceFileSet", language="C99")
    for name in sources:
        xml.SubElement(files, "SourceFile", name=name)
    xml.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + xml.tostring(root, encoding="unicode") + "\n"
