"""What parts of a mechanism are for: said once in the declaration, so that no command needs a table of names.

piston   travel and net gas force, bore from the case      bearing  its reactions, relative turn, radius, place
rotor    angle, driving or opposing torque, hinge          guide    normal reaction, travel
teeth    tangential force, relative turn                   rod      lengths and masses of a slider crank
closing  the force that a rigid mechanism leaves open      face     where gas acts, of a mechanism that has a choice
shaft    discs and sections of a shaft that twists

A place is where `[friction]` of a case looks a part up: bearings at `main_bearings`, `crank_pins` or `piston_pins`,
guides at `guides`. Sizes of a role are expressions of parameters; they are stored as text.
"""

from collections.abc import Iterable
from math import pi

from sympy import Expr, Symbol

from mechsym.derive.letters import Letters, listed
from mechsym.derive.linkage import Joint
from mechsym.derive.rates import output
from mechsym.derive.refuse import place, refuse
from mechsym.files import Json

_TWO_TURNS = 4 * pi + 1e-9
_JOINT_OF = {"bearing": ("pin",), "guide": ("slider", "slot"), "teeth": ("gear",)}
_BEARING_PLACES = ("main_bearings", "crank_pins", "piston_pins")


class Roles(Letters):
    """The part of a declaration that says what its parts are for."""

    def _start_roles(self) -> None:
        self.roles: dict[str, list[Json]] = {}
        self.closed_forces: list[Symbol] = []
        self.requires: list[dict[str, str]] = []

    def _role(self, role: str, **facts: object) -> None:
        if not isinstance(facts["name"], str):
            refuse(f"the {role} {facts['name']!r} has no name; name it by a text")
        if role != "face":  # sides of a slider have signs
            self._usable(facts["name"])  # results are called after it
        if any(f["name"] == facts["name"] for f in self.roles.get(role, [])):
            refuse(f"the {role} {facts['name']!r} is declared twice in {self.name}; give one of them another name")
        self.roles.setdefault(role, []).append(facts)
        self.where[f"{role} {facts['name']}"] = place()

    def _input(self, symbol: Symbol, role: str, unit: str) -> str:
        fitting = [s for s in self.input_list if self.units[s.name] == unit]
        if symbol not in fitting:
            refuse(f"the {role} takes {symbol}, which is no input in {unit}; there are {listed(fitting)}")
        return str(symbol.name)

    def _parameter(self, symbol: Symbol, unit: str) -> str:
        if symbol not in self.parameter_list or self.units[symbol.name] != unit:
            refuse(f"{symbol} is no parameter in {unit}; declare it: m.parameters('{symbol}', '{unit}')")
        return symbol.name

    def _turned(self, turns: object, name: str) -> str | list[str]:
        """The relative turn as an output; or the names of outputs and coordinates that add up to it."""
        if not isinstance(turns, tuple):
            return self._shown(turns, name, "rad", 1)
        for one in turns:
            if one not in {*self.q, *self.kinematic_outputs}:
                refuse(f"{name} adds up {one}, which is neither a coordinate nor an output; there are {listed(self.q)}")
        return [one.name for one in turns]

    def _shown(self, value: Expr | float, name: str, unit: str, order: int) -> str:
        """An expression as a kinematic output with its derivatives."""
        value = self._checked(value, unit, name)
        if not value.free_symbols & {*self.tape.variables, *self.tape.entries}:
            refuse(f"{name} = {value} moves with no coordinate; there are {listed(self.q)}")
        symbol = value if value in {*self.tape.entries, *self.q} else self.let(name, value, unit)
        output(self, symbol, order=order)
        return symbol.name

    def piston(
        self, name: str, *, travel: Expr | float, force: Expr | float, fires: float = 0.0, masses: object = (),
        loads: object = (), stroke: Expr | float | None = None,
    ) -> None:  # fmt: skip
        """A piston: its travel, positive away from the head [m], the net gas force on it as an input, positive likewise
        [N], how long after its own first top dead centre it fires [rad], the parameters that move with it [kg], the
        reactions that limit a design [N], and its stroke, by which the values of a case are judged [m]."""
        shown = self._shown(travel, f"travel_{name}", "m", 2)
        said = {
            "masses": [self._parameter(p, "kg") for p in _listed(masses)],
            "loads": [str(r) for r in _listed(loads)],
        }
        kept = {k: v for k, v in said.items() if v}
        after, pushed = self._number(fires, f"fires of {name}"), self._input(force, "piston", "N")
        if abs(after) > _TWO_TURNS:
            refuse(f"fires = {after:g} of the piston {name!r} is beyond two turns; it is in rad: 180 deg are pi")
        if other := next((p["name"] for p in self.roles.get("piston", []) if p["force"] == pushed), None):
            why = f"the pistons {other!r} and {name!r} are pushed by one input, {pushed}"
            refuse(f"{why}; give each an input of its own, or make a chamber that they share one travel")
        if len({*kept.get("masses", ())}) < len(kept.get("masses", ())):
            refuse(f"a mass of the piston {name!r} is named twice: {', '.join(kept['masses'])}; leave one away")
        sizes = self._sizes(name, stroke=(stroke, "m"))
        self._role("piston", name=name, travel=shown, force=pushed, fires=after, **kept, **sizes)

    def rotor(
        self,
        name: str,
        *,
        angle: Expr | float,
        load: Expr | float | None = None,
        drive: Expr | float | None = None,
        inertia: Expr | float | None = None,
        hinge: Expr | float | None = None,
        weight: Expr | float | None = None,
        unbalance: Expr | float | None = None,
    ) -> None:
        """A rotor: its coordinate [rad], the input that takes a load, positive against the motion, one that drives it,
        one that a hinge acts on [N*m], the parameter that a flywheel adds to [kg*m^2], the torque of its own weight
        [N*m], and its unbalance on the side of the crank pin [kg*m]."""
        if angle not in self.q:
            refuse(f"the rotor {name!r} turns by {angle}, which is no coordinate; there are {listed(self.q)}")
        taken = {"load": load, "drive": drive} | ({} if hinge is None else {"hinge": hinge})
        self._require_free(name, [str(v) for v in taken.values() if v is not None])
        named = {} if inertia is None else {"inertia": self._parameter(inertia, "kg*m^2")}
        if weight is not None:
            named["weight"] = self._size_of(weight, "N*m", f"weight of {name}", moving=(angle,))
        self._role("rotor", name=name, angle=str(angle), **{
            k: None if v is None else self._input(v, "rotor", "N*m") for k, v in taken.items()
        }, **named, **self._sizes(name, unbalance=(unbalance, "kg*m")))  # fmt: skip

    def _require_free(self, name: str, wanted: list[str]) -> None:
        """Refuse an input that a rotor has already."""
        for known in self.roles.get("rotor", []):
            if both := {known["load"], known["drive"]} & {*wanted}:
                why = f"the rotors {known['name']!r} and {name!r} take one input, {both.pop()}"
                refuse(f"{why}; give each an input of its own")
        if len({*wanted}) < len(wanted):
            refuse(f"{wanted[0]} drives the rotor {name!r} and is its load; declare one input for each")

    def bearing(
        self,
        name: str,
        *,
        reactions: str | tuple[str, ...],
        turns: Expr | tuple[Expr, ...],
        radius: Symbol | None = None,
        at: str = "",
        throw: Expr | float | None = None,
        ways: tuple[Expr | float, ...] = (),
    ) -> None:
        """A pin or journal: its two reactions, or a tuple of the only one [N], the turn of one part in the other, or a
        tuple of turns that add up to it [rad], the radius [m], its place; of a crank pin the throw [m]; the directions
        of the reactions in the frame, where they are not x and y [rad]."""
        turned = self._turned(turns, f"turn_{name}")
        pair = [str(r) for r in _listed(reactions)]
        if len({*pair}) != 2 and not (isinstance(reactions, tuple) and len(pair) == 1):
            refuse(f"the bearing {name!r} takes two reactions; write reactions=('R_x_A', 'R_y_A')")
        if radius is not None and (radius not in self.parameter_list or self.units[radius.name] != "m"):
            refuse(f"the radius {radius} of the bearing {name!r} is no parameter in m; declare one for it")
        if at and at not in _BEARING_PLACES:
            refuse(f"the bearing {name!r} is at {at!r}; there are {', '.join(_BEARING_PLACES)}")
        held = None if radius is None else radius.name
        named: Json = ({"at": at} if at else {}) | self._sizes(name, throw=(throw, "m"))
        named |= {"ways": [float(way) for way in ways]} if ways else {}
        self._role("bearing", name=name, reactions=pair, turns=turned, radius=held, **named)

    def guide(
        self, name: str, *, reaction: str | None, travel: Expr | float, at: str = "", way: float | None = None
    ) -> None:
        """A guide or slot: its normal reaction, None where it carries nothing [N], the travel along it [m], its
        place, the direction of the reaction in the frame, where that is not y [rad]."""
        if at not in ("", "guides"):
            refuse(f"the guide {name!r} is at {at!r}; there is guides")
        borne = None if reaction is None else str(reaction)
        named = ({"at": at} if at else {}) | ({} if way is None else {"way": float(way)})
        self._role("guide", name=name, reaction=borne, travel=self._shown(travel, f"slide_{name}", "m", 1), **named)

    def teeth(
        self,
        name: str,
        *,
        force: str,
        radius: Expr | float,
        turns: Expr | tuple[Expr, ...] | None = None,
        planet: Expr | float | None = None,
        flank: Expr | float | None = None,
    ) -> None:
        """Teeth in mesh: their tangential force [N], the pitch radius of the driven wheel [m], the turn of one wheel in
        the other, or a tuple of turns that add up to it [rad]; of a planet on the crank pin that drives the piston, by
        which such an engine is sized, the mass at its centre [kg] and the pressure angle [rad], both parameters."""
        named = {} if turns is None else {"turns": self._turned(turns, f"turn_{name}")}
        said = (("planet", planet, "kg"), ("flank", flank, "rad"))
        named |= {what: self._parameter(letter, unit) for what, letter, unit in said if letter is not None}
        self._role("teeth", name=name, force=str(force), radius=self._parameter(radius, "m"), **named)

    def rod(
        self,
        name: str,
        *,
        throw: Expr | float,
        length: Expr | float,
        moving: Expr | float,
        swing: Expr | float | None = None,
        centre: Expr | float = 0,
        mass: Expr | float = 0,
        inertia: Expr | float = 0,
        beyond: Expr | float | None = None,
        unbalance: Expr | float = 0,
        gravity: Expr | float | None = None,
    ) -> None:
        """The rod of a slider crank: its angle, an output by which the chains that sources print go on [rad], the
        throw, its length, from the crank pin to its centre of mass [m], its mass [kg], its inertia there [kg*m^2], the
        mass that moves with the piston, and that beyond a crosshead [kg], the crank's unbalance on the pin's side
        [kg*m], the parameter of free fall."""
        named = {} if gravity is None else {"gravity": self._parameter(gravity, "m/s^2")}
        swung = None if swing is None else self._shown(swing, f"swing_{name}", "rad", 1)
        self._role("rod", name=name, swing=swung, **self._sizes(
            name, throw=(throw, "m"), length=(length, "m"), centre=(centre, "m"), mass=(mass, "kg"),
            inertia=(inertia, "kg*m^2"), moving=(moving, "kg"), beyond=(beyond, "kg"), unbalance=(unbalance, "kg*m"),
        ), **named)  # fmt: skip

    def shaft(self, name: str, *, discs: object, stiffness: object, damping: object, masses: object = ()) -> None:
        """A shaft that twists, from its free end to the flywheel: the inertia of each disc alone [kg*m^2], the
        stiffness [N*m/rad] and the damping [N*m*s/rad] of each section between two, and the parameters that go to and
        fro with it [kg]."""
        sizes = {"discs": (discs, "kg*m^2"), "stiffness": (stiffness, "N*m/rad"), "damping": (damping, "N*m*s/rad")}
        said = {
            what: [self._size_of(v, unit, f"{what} of {name}") for v in _listed(values)]
            for what, (values, unit) in sizes.items()
        }
        if not len(said["discs"]) - 1 == len(said["stiffness"]) == len(said["damping"]):
            refuse(f"the shaft {name!r} needs a stiffness and a damping for each section between two of its discs")
        self._role("shaft", name=name, **said, masses=[self._parameter(p, "kg") for p in _listed(masses)])

    def part(self, name: str, *, inertia: Expr | float, mass: Expr | float, length: Expr | float) -> None:
        """A part that turns about its own centre: the parameter of its inertia there [kg*m^2], its mass [kg] and its
        length [m], by which that inertia is judged."""
        sizes = self._sizes(name, mass=(mass, "kg"), length=(length, "m"))
        self._role("part", name=name, inertia=self._parameter(inertia, "kg*m^2"), **sizes)

    def require(self, value: Expr | float, *, above: Expr | float, unit: str, what: str, way: str) -> None:
        """Refuse numbers of a case for which an expression of the parameters is not above another, both in one unit:
        what is wrong then, and the way out."""
        row = {"value": self._size_of(value, unit, what), "above": self._size_of(above, unit, what), "unit": unit}
        self.requires.append(row | {"what": what, "way": way})

    def closing(self, name: str, **guides: tuple[Expr | float, Expr | float]) -> list[Symbol]:
        """The force that a mechanism overconstrained by one leaves open, along its crank: a rule of `[closing]` in a
        case shares it out between the crank and two guides. For each guide its force where the open one is 0 [N], and
        how much of the open one it takes [-], by the name of its reaction. Gives the open force and those of the
        guides, for `m.closed`."""
        if len(guides) != 2:
            refuse(f"the closing {name!r} shares a force with two guides, and {len(guides)} are named")
        symbols = [self._closed_force(each) for each in (name, *guides)]
        rows = [
            {
                "name": guide,
                "free": self._size_of(free, "N", f"free force of {guide}", moving=self._moving_letters()),
                "share": self._size_of(share, "-", f"share of {guide}", moving=tuple(self.q)),
            }
            for guide, (free, share) in guides.items()
        ]
        self._role("closing", name=name, guides=rows, gives={})
        return symbols

    def closed(self, name: str, value: Expr | float) -> Symbol:
        """A further reaction that follows from the forces of `m.closing` [N]."""
        if "closing" not in self.roles:
            refuse(f"nothing closes {self.name}; declare m.closing before {name!r}")
        text = self._size_of(value, "N", name, moving=self._moving_letters())
        self.roles["closing"][0]["gives"][name] = text
        return self._closed_force(name)

    def _closed_force(self, name: str) -> Symbol:
        symbol = self._reaction(name, "N")
        self.dimensions[symbol] = self._unit("N")
        self.closed_forces.append(symbol)
        return symbol

    def _moving_letters(self) -> tuple[Symbol, ...]:
        """What a reaction may hang on: coordinates with their rates, outputs, inputs, reactions."""
        rates = [Symbol(f"{q.name}{dots}", real=True) for q in self.q for dots in ("d", "dd")]
        return (
            *self.q, *rates, *self.kinematic_outputs, *self.input_list, *self.reaction_of.values(), *self.closed_forces,
        )  # fmt: skip

    def face(
        self,
        name: str,
        *,
        travel: Expr | float,
        force: Expr | float,
        sense: int,
        closes: Expr | float,
        masses: object = (),
        stroke: Expr | float | None = None,
    ) -> None:
        """A working face that a case may name in `[faces]`: the output by which its slider moves [m], the input that
        takes its force, positive along it [N], 1 where the gas pushes along it and -1 where against it, the angle at
        which its chamber is least, the parameters that move with it [kg], and its stroke [m]."""
        moving = [self._parameter(p, "kg") for p in _listed(masses)]
        self._role(
            "face", name=name, travel=self._shown(travel, f"travel_{name}", "m", 2), sense=float(sense),
            force=self._input(force, "face", "N"), closes=self._size_of(closes, "rad", f"dead centre of {name}"),
            masses=moving, **self._sizes(name, stroke=(stroke, "m")),
        )  # fmt: skip

    def alike(self, name: str, **parameters: Expr | float) -> None:
        """A mechanism whose piston moves as every piston of this one, with its parameters by those of this one: what
        one cylinder of it sees."""
        sizes = {letter: self._size_of(value, "", f"{letter} of {name}") for letter, value in parameters.items()}
        self._role("alike", name=name, parameters=sizes)


def require_reactions(m: Roles, link_joints: Iterable[Joint]) -> None:
    """Refuse a role that names a reaction of no joint, or of one that is no part of its kind; joints may come later."""
    known = {s.name for s in (*m.reaction_of.values(), *m.multiplier_of.values())} | {*m.dynamic_outputs}
    joints = {m.reaction_of[d].name: j for j in link_joints if not j.through for d in j.displacements}
    known |= {s.name for s in m.closed_forces}
    for role, key in (("bearing", "reactions"), ("guide", "reaction"), ("teeth", "force"), ("piston", "loads")):
        for facts in m.roles.get(role, []):
            for wanted in _listed(facts.get(key, ())):
                if wanted is not None and wanted not in known:
                    why = f"the {role} {facts['name']!r} takes {wanted}, which is the reaction of no joint"
                    refuse(f"{why}; there are {', '.join(sorted(known)) or 'none'}", m.where[f"{role} {facts['name']}"])
                joint = joints.get(wanted)
                if role in _JOINT_OF and joint and joint.kind not in _JOINT_OF[role]:
                    why = f"the {role} {facts['name']!r} takes {wanted}, which is the reaction of a {joint.kind}"
                    way = f"name that of a {' or '.join(_JOINT_OF[role])}"
                    refuse(f"{why}; {way}", m.where[f"{role} {facts['name']}"])
            if role == "bearing" and len(of := {joints[r].name for r in facts[key] if r in joints}) > 1:
                why = f"the bearing {facts['name']!r} takes reactions of two joints, {' and '.join(sorted(of))}"
                refuse(f"{why}; name those of one", m.where[f"bearing {facts['name']}"])


def _listed(value: object) -> tuple[Expr, ...]:
    return tuple(value) if isinstance(value, (tuple, list)) else (value,)
