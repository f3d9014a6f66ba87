"""What parts of a mechanism are for: said once in the declaration, so that no command needs a table of names.

piston   travel and net gas force, bore from the case      bearing  two reactions, relative turn, radius
rotor    angle, driving or opposing torque                 guide    normal reaction, travel
teeth    tangential force                                  draw_*   lines, circles and boxes at declared points
"""

from typing import Any

from sympy import Expr, Symbol

from mechsym.derive.linkage import point_of
from mechsym.derive.outputs import output
from mechsym.derive.refuse import place, refuse

PAINTED = ("frame", "flywheel", "piston", "planet", "rod", "crank", "joint")


class Roles:
    """The part of a declaration that says what its parts are for."""

    tape: Any
    kinematic_outputs: list[Symbol]
    input_list: list[Symbol]
    parameter_list: list[Symbol]
    units: dict[str, str]
    where: dict[str, str]
    q: list[Symbol]
    name: str

    def _checked(self, value: Any, unit: str, what: str) -> Expr:
        """An expression in its unit (see `Letters`)."""
        raise NotImplementedError

    def _start_roles(self) -> None:
        self.roles: dict[str, list[dict[str, Any]]] = {}
        self.shapes: list[dict[str, Any]] = []
        self.shape_points: dict[str, Expr] = {}

    def let(self, name: str, value: Any, unit: str = "") -> Symbol:
        """Name an intermediate (see `Declaration`)."""
        raise NotImplementedError

    def _role(self, role: str, **facts: Any) -> None:
        if any(f["name"] == facts["name"] for f in self.roles.get(role, [])):
            refuse(f"the {role} {facts['name']!r} is declared twice in {self.name}; give one of them another name")
        self.roles.setdefault(role, []).append(facts)
        self.where[f"{role} {facts['name']}"] = place()

    def _input(self, symbol: Any, role: str) -> str:
        if symbol not in self.input_list:
            refuse(f"the {role} takes {symbol}, which is no input; inputs are {', '.join(map(str, self.input_list))}")
        return symbol.name

    def _parameter(self, symbol: Any, unit: str) -> str:
        if symbol not in self.parameter_list or self.units[symbol.name] != unit:
            refuse(f"{symbol} is no parameter in {unit}; declare it: m.parameters('{symbol}', '{unit}')")
        return symbol.name

    def _shown(self, value: Any, name: str, unit: str, order: int) -> str:
        """An expression as a kinematic output with its derivatives."""
        value = self._checked(value, unit, name)
        symbol = value if value in {*self.tape.entries, *self.q} else self.let(name, value, unit)
        output(self, symbol, order=order)
        return symbol.name

    def piston(
        self, name: str, *, travel: Any, force: Any, fires: float = 0.0, masses: Any = (), loads: Any = ()
    ) -> None:
        """A piston: its travel, positive away from the head [m], the net gas force on it as an input, positive likewise
        [N], how long after its own first top dead centre it fires [rad], the parameters that move with it [kg], and
        the reactions that limit a design [N]."""
        shown = self._shown(travel, f"travel_{name}", "m", 2)
        said = {
            "masses": [self._parameter(p, "kg") for p in _listed(masses)],
            "loads": [str(r) for r in _listed(loads)],
        }
        self._role("piston", name=name, travel=shown, force=self._input(force, "piston"), fires=float(fires), **{
            k: v for k, v in said.items() if v
        })  # fmt: skip

    def rotor(self, name: str, *, angle: Any, load: Any = None, drive: Any = None, inertia: Any = None) -> None:
        """A rotor: its coordinate [rad], the input that takes a load, positive against the motion, one that drives it
        [N*m], and the parameter that a flywheel adds to [kg*m^2]."""
        if angle not in self.q:
            refuse(f"the rotor {name!r} turns by {angle}, which is no coordinate; there are {_all(self.q)}")
        taken = {"load": load, "drive": drive}
        kept = {} if inertia is None else {"inertia": self._parameter(inertia, "kg*m^2")}
        self._role("rotor", name=name, angle=str(angle), **{
            k: None if v is None else self._input(v, "rotor") for k, v in taken.items()
        }, **kept)  # fmt: skip

    def bearing(self, name: str, *, reactions: tuple[Any, Any], turns: Any, radius: Any = None) -> None:
        """A pin or journal: its two reactions [N], the turn of one part in the other [rad], the radius [m]."""
        turned = self._shown(turns, f"turn_{name}", "rad", 1)
        pair = [str(r) for r in _listed(reactions)]
        if len(pair) != 2:
            refuse(f"the bearing {name!r} takes two reactions; write reactions=('R_x_A', 'R_y_A')")
        if radius is not None and (radius not in self.parameter_list or self.units[radius.name] != "m"):
            refuse(f"the radius {radius} of the bearing {name!r} is no parameter in m; declare one for it")
        held = None if radius is None else radius.name
        self._role("bearing", name=name, reactions=pair, turns=turned, radius=held)

    def guide(self, name: str, *, reaction: Any, travel: Any) -> None:
        """A guide or slot: its normal reaction [N] and the travel along it [m]."""
        self._role("guide", name=name, reaction=str(reaction), travel=self._shown(travel, f"slide_{name}", "m", 1))

    def teeth(self, name: str, *, force: Any, radius: Any) -> None:
        """Teeth in mesh: their tangential force [N] and the pitch radius of the driven wheel [m]."""
        self._role("teeth", name=name, force=str(force), radius=str(radius))

    def _point_names(self, points: tuple[Any, ...]) -> list[list[str]]:
        found = []
        for point in points:
            pair = point if isinstance(point, tuple) else point_of(point).xy
            names = []
            for axis, value in zip("xy", pair, strict=True):
                name = f"draw_{axis}{len(self.shape_points) // 2}"
                self.shape_points[name] = self.tape.named(self._checked(value, "m", "point of the drawing"))
                names.append(name)
            found.append(names)
        return found

    def _shape(self, kind: str, role: str, points: tuple[Any, ...], **sizes: Any) -> None:
        if role not in PAINTED:
            refuse(f"nothing is painted as {role!r}; there are {', '.join(PAINTED)}")
        named = {key: self._size(size) for key, size in sizes.items()}
        self.shapes.append({"kind": kind, "role": role, "points": self._point_names(points), **named})

    def draw_line(self, *points: Any, role: str = "rod") -> None:
        """Draw a line through points: pairs (x, y) [m] or points of links."""
        self._shape("line", role, points)

    def draw_circle(self, point: Any, radius: Any, role: str = "joint") -> None:
        """Draw a circle of a radius [m] about a point [m]."""
        self._shape("circle", role, (point,), radius=radius)

    def draw_box(self, point: Any, width: Any, height: Any, role: str = "piston") -> None:
        """Draw a box of a width and height [m] about a point [m], its sides along x and y."""
        self._shape("box", role, (point,), width=width, height=height)

    def _size(self, value: Any) -> str:
        name = f"draw_s{len(self.shape_points)}"
        self.shape_points[name] = self.tape.named(self._checked(value, "m", "size in the drawing"))
        # an even count keeps the numbering of points
        self.shape_points[f"{name}_"] = self.shape_points[name]
        return name


def require_reactions(m: Any) -> None:
    """Refuse a role that names a reaction which no joint has; joints may be declared after it."""
    known = {s.name for s in (*m.reaction_of.values(), *m.multiplier_of.values())} | {*m.dynamic_outputs}
    for role, key in (("bearing", "reactions"), ("guide", "reaction"), ("teeth", "force"), ("piston", "loads")):
        for facts in m.roles.get(role, []):
            for wanted in _listed(facts.get(key, ())):
                if wanted not in known:
                    why = f"the {role} {facts['name']!r} takes {wanted}, which is the reaction of no joint"
                    refuse(f"{why}; there are {', '.join(sorted(known)) or 'none'}", m.where[f"{role} {facts['name']}"])


def _all(symbols: list[Symbol]) -> str:
    return ", ".join(map(str, symbols)) or "none"


def _listed(value: Any) -> tuple[Any, ...]:
    return tuple(value) if isinstance(value, (tuple, list)) else (value,)
