r"""Values of a case by the size of its own machine: bore, crank, and the mass that moves.

.. math:: \frac{I}{m r^2}, \qquad \frac{I_C}{m_\mathrm{part}\,l^2}, \qquad \sqrt{k/I}, \qquad \frac{c}{2\sqrt{k I}}

A value in the wrong unit, or with a slip of three decimals, is out of proportion to the machine that it belongs to; an
absolute range wide enough for a model and a ship would let it pass. Zero leaves a part away and is never doubted.
"""

import dataclasses
import math
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from mechsym.mechanisms.proportions import Proportions
from mechsym.mechanisms.traits import ElasticShaft
from mechsym.plausible import Doubt, letters, proportion

# lengths by the bore: section, names of its fields (all lengths where none is named), kind
_BY_BORE: tuple[tuple[str, tuple[str, ...], str], ...] = (
    ("friction", ("radius_piston_pin", "radius_crank_pin", "radius_main"), "bearing_size"),
    ("losses", ("bearing_radius",), "bearing_size"),
    ("rollers", ("radius", "width", "plane_offset"), "roller_size"),
    ("breathing", ("inlet_lift", "exhaust_lift"), "valve_lift"),
    ("breathing", ("inlet_diameter", "exhaust_diameter", "throttle_diameter", "tailpipe_diameter"), "throat_size"),
    ("scavenging", ("valve_lift",), "valve_lift"),
    ("scavenging", ("valve_diameter",), "throat_size"),
    ("scavenging", ("port_width",), "port_size"),
    ("rings", ("heights",), "ring_size"),
    ("sizing", ("ring_thickness",), "ring_size"),
    ("sizing", ("reboring", "fillet", "carrier_wall"), "thin_size"),
    ("sizing", ("reach",), "part_size"),
    ("part_piston", ("ring_radial", "ring_axial"), "ring_size"),
    ("part_piston", ("barrel", "land"), "thin_size"),
    ("part_piston", ("head", "land_top", "height", "rod", "rod_length"), "part_size"),
    ("part_cylinder", ("wall",), "thin_size"),
    ("part_cylinder", ("flange", "length"), "part_size"),
    ("friction", ("module",), "tooth_size"),
    ("part_gears", ("module",), "tooth_size"),
    ("part_gears", ("face", "ring_outside", "pinion_bore"), "part_size"),
    ("part_crank", (), "part_size"),
    ("part_crosshead", ("pin_diameter", "pin_length", "crank_pin_diameter", "crank_pin_length", "shoe_width",
                        "shoe_length", "rod_diameter", "web_width", "web_thickness", "web_arm"), "part_size"),
    ("stirling", ("heater_diameter", "cooler_diameter"), "tube_share"),
    ("stirling", ("seal_length", "shuttle_length"), "seal_share"),
)  # fmt: skip
# absolute pressure of the charge, what each kind of cycle calls it
_CHARGE = (("cycle", "intake_pressure"), ("cycle", "p_s"), ("cycle", "mean_pressure"), ("cycle", "p_suction"),
           ("cycle", "inlet_pressure"), ("cycle", "exhaust_pressure"))  # fmt: skip
MOVING = "moving mass"
_ATMOSPHERE = 101325.0  # [Pa]
_Told = tuple[str, str, float]  # kind, what it is, value


def by_size(sections: Mapping[str, Any], sizes: Proportions, bore: float | None) -> tuple[Doubt, ...]:
    """What is out of proportion to the machine.

    Parameters
    ----------
    bore : float or None
        Of the piston; None where it is not known [m]
    """
    told = [*_inertias(sections, sizes), *_by_stroke(sections, sizes), *_fitted(sections)]
    # without a bore the stroke stands for it
    told.append(
        ("mass_density", f"{MOVING} / (bore^2 * stroke)", sizes.mass / ((bore or sizes.stroke) ** 2 * sizes.stroke))
    )
    if bore:
        told.append(("stroke_ratio", "stroke / bore", sizes.stroke / bore))
        told += [
            *_lengths(sections, bore),
            *_valves(sections, bore),
            *_volumes(sections, bore, sizes.stroke),
            *_areas(sections, sizes, bore),
        ]
    return _doubts(told)


def by_shaft(shaft: ElasticShaft, parameters: Any) -> tuple[Doubt, ...]:
    """Stiffness and damping of an elastic shaft by its lightest disc."""
    inertia = min(shaft.discs(parameters))
    told: list[_Told] = []
    for k, c in zip(*shaft.springs(parameters), strict=True):
        told.append(("shaft_frequency", "sqrt(stiffness / least inertia), rad/s", math.sqrt(k / inertia)))
        told.append(("shaft_damping", "damping / (2 sqrt(stiffness * inertia))", c / (2 * math.sqrt(k * inertia))))
    return _doubts(told)


def by_unit(sections: Mapping[str, Any], names: tuple[str, ...]) -> tuple[Doubt, ...]:
    """What is beyond the largest machines, in sections of letters that may mean anything."""
    found = {}
    for section in names:
        for field in _fields(sections.get(section)):
            value = getattr(sections[section], field.name)
            values = [v for v in (value if isinstance(value, tuple) else (value,)) if isinstance(v, float)]
            found[f"{section}.{field.name}"] = (max(values, key=abs, default=0.0), field.metadata.get("unit", ""))
    return letters(found)


def _doubts(told: Iterable[_Told]) -> tuple[Doubt, ...]:
    return tuple(d for code, name, value in told if value for d in proportion(code, name, value))


def _fields(record: Any) -> tuple[dataclasses.Field[Any], ...]:
    return dataclasses.fields(record) if dataclasses.is_dataclass(record) else ()


def _number(sections: Mapping[str, Any], section: str, name: str) -> float:
    return getattr(sections.get(section), name, None) or 0.0


def _inertias(sections: Mapping[str, Any], sizes: Proportions) -> Iterator[_Told]:
    for letter, (inertia, like) in sizes.parts.items():
        if like > 0:
            yield "part_inertia", f"parameters.{letter} / (mass * length^2)", inertia / like
    scale = sizes.mass * (sizes.stroke / 2) ** 2
    if scale <= 0:
        return
    about = "(moving mass * half stroke^2)"
    for letter, inertia in sizes.shafts.items():
        yield "inertia", f"parameters.{letter} / {about}", inertia / scale
    for letter, moment in sizes.unbalances.items():
        yield "unbalance", f"parameters.{letter} / (moving mass * half stroke)", abs(moment) * sizes.stroke / 2 / scale
    kept = _number(sections, "flywheel", "inertia") / scale
    if kept > 1:  # a small one is as good as none
        yield "inertia", f"flywheel.inertia / {about}", kept


def _by_stroke(sections: Mapping[str, Any], sizes: Proportions) -> Iterator[_Told]:
    """Lengths along the stroke, and what belongs to the gears and rollers of the mechanism."""
    parts = ("heater", "cooler", "regenerator")
    lengths = [("spring", "H", "spring_height"), ("part_crosshead", "rod_length", "piston_rod")]
    lengths += [("stirling", f"{part}_length", "exchanger_share") for part in parts]
    for section, name, code in lengths:
        yield code, f"{section}.{name} / stroke", _number(sections, section, name) / sizes.stroke
    radius = _number(sections, "part_gears", "module") * _number(sections, "part_gears", "teeth_pinion") / 2
    yield "gear_pitch", "part_gears.module * teeth_pinion / 2 / (stroke / 4)", 4 * radius / sizes.stroke
    if roller := _number(sections, "rollers", "radius"):
        yield (
            "bearing_share",
            "losses.bearing_radius / rollers.radius",
            (_number(sections, "losses", "bearing_radius") / roller),
        )
    for letter, ratio in sizes.unequal.items():
        yield "unequal", f"largest parameters.{letter} / least", ratio
    if sizes.span is not None:
        yield "opposed_span", "distance of the shafts / (r + l1 + l2 of both)", sizes.span


def _fitted(sections: Mapping[str, Any]) -> Iterator[_Told]:
    """Constants of fitted laws by the law's own."""
    for section, names in (("heat_transfer", ("c1", "c2")), ("friction_pressure", ())):
        for field in _fields(sections.get(section)):
            own = field.default
            if isinstance(own, float) and own and (field.name in names or not names):
                about = f"{section}.{field.name} / the law's own {own:g}"
                yield "fitted_constant", about, _number(sections, section, field.name) / own


def _areas(sections: Mapping[str, Any], sizes: Proportions, bore: float) -> Iterator[_Told]:
    """Pressures, forces and stiffnesses by the area of a piston."""
    area = math.pi / 4 * bore**2
    charge = next((p for p in (_number(sections, *key) for key in _CHARGE) if p), _ATMOSPHERE)
    for section, name in (("cycle", "p_back"), ("chamber", "back_pressure")):
        yield "back_pressure_share", f"{section}.{name} / charge", _number(sections, section, name) / charge
    faces = getattr(sections.get("faces"), "areas", ())
    swept = (sum(faces) or area * sizes.pistons) * sizes.stroke * (_number(sections, "chamber", "pistons") or 1)
    yield (
        "load_pressure",
        "load.torque * 2 pi / swept volume",
        2 * math.pi * _number(sections, "load", "torque") / swept,
    )
    yield (
        "reaction_limit",
        "limits.roller_reaction / piston area",
        _number(sections, "limits", "roller_reaction") / area,
    )
    for face in faces:
        yield "face_area", "faces.areas / piston area", face / area
    for name in ("k_a", "k_b", "k_c"):
        yield (
            "joint_stiffness",
            f"closing.{name} * bore / (1 MPa * piston area)",
            (_number(sections, "closing", name) * bore / (1e6 * area)),
        )
    if sizes.pitch is not None:
        yield "cylinder_pitch", "least distance of two cylinders / bore", sizes.pitch / bore or 1e-9


def _valves(sections: Mapping[str, Any], bore: float) -> Iterator[_Told]:
    """Valves by each other, and together by the bore."""
    for section, valve in (("breathing", "inlet"), ("breathing", "exhaust"), ("scavenging", "valve")):
        if width := _number(sections, section, f"{valve}_diameter"):
            about = f"{section}.{valve}_lift / {valve}_diameter"
            yield "lift_share", about, _number(sections, section, f"{valve}_lift") / width
    squares = sum(_number(sections, "breathing", f"{valve}_diameter") ** 2 for valve in ("inlet", "exhaust"))
    about = "breathing.valves * (inlet_diameter^2 + exhaust_diameter^2) / bore^2"
    yield "valve_area", about, _number(sections, "breathing", "valves") * squares / bore**2


def _lengths(sections: Mapping[str, Any], bore: float) -> Iterator[_Told]:
    for section, names, code in _BY_BORE:
        fields = _fields(sections.get(section))
        for name in names or [f.name for f in fields if f.metadata.get("unit") == "m"]:
            value = getattr(sections.get(section), name, None) or 0.0
            for length in set(value) if isinstance(value, tuple) else (value,):
                yield code, f"{section}.{name} / bore", length / bore
    for field in _fields(sections.get("part_masses")):
        yield (
            "mass_density",
            f"part_masses.{field.name} / bore^3",
            getattr(sections["part_masses"], field.name) / bore**3,
        )


def _volumes(sections: Mapping[str, Any], bore: float, stroke: float) -> Iterator[_Told]:
    swept = math.pi / 4 * bore**2 * stroke
    for name in ("dead_hot", "dead_cold", "dead_regenerator"):
        yield "dead_volume", f"cycle.{name} / swept volume", _number(sections, "cycle", name) / swept
    for name in ("plenum_volume", "manifold_volume"):
        yield "pipe_volume", f"breathing.{name} / swept volume", _number(sections, "breathing", name) / swept
    told = {name: _number(sections, "stirling", name) for name in ("buffer_volume", "conductance")}
    yield "buffer_volume", "stirling.buffer_volume / swept volume", told["buffer_volume"] / swept
    copper = 400 * math.pi / 4 * bore**2 / stroke  # a solid block of the piston's width, one stroke long [W/K]
    yield "conductance", "stirling.conductance / that of solid copper", told["conductance"] / copper
