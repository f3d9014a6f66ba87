"""What a motion meets and rubs on: stops, contacts, backlash, friction. Each acts through an input of its own.

m.stop(y, at=0, restitution=e)                                  y stays above 0, a blow gives e of the speed back
m.contact("heel", block.at(b), m.frame.line(), restitution=0)   a point, or a circle, on the left of a line
m.friction("A", mu=(mu_s, mu_k), radius=r)                      in a joint, pressed by its reactions
m.friction(x, mu=mu, normal=m1 * g)                             along a coordinate
"""

from collections.abc import Callable
from typing import Any

from sympy import Expr, Integer, Piecewise, Symbol, cos, sin, sqrt

from mechsym.derive import dimensions
from mechsym.derive.linkage import Joint, Link, LinkLine, Pair, point_of
from mechsym.derive.refuse import refuse
from mechsym.derive.roles import Roles

_LAWS = ("set-valued", "smooth")


class Unilateral(Roles):
    """The part of a declaration that says what a motion meets and rubs on."""

    force: Callable[..., None]  # see `Declaration`
    frame: Link
    link_joints: list[Joint]

    def stop(
        self, of: Expr | float, *, at: Expr | float = 0, side: int = 1, restitution: Expr | float | None = None,
        stiffness: Expr | float | None = None, damping: Expr | float | None = None, name: str = "",
    ) -> None:  # fmt: skip
        """A stop of a coordinate, or of an expression, at a value [m or rad]: the motion stays above it, with `side=-1`
        below. A blow gives `restitution` of the speed back [-]; or it presses by k d (1 + c d') where it is passed by
        d: `stiffness` k [N/m, N*m/rad], `damping` c [s/m, s/rad]."""
        kind = self._moves(of, "stop")
        if side not in (1, -1):
            refuse(f"side = {side!r} of a stop must be 1, where the motion is above it, or -1")
        gap = side * (of - self._sized(at, kind, f"{name or of}_at", "place of the stop"))
        self._stop(name or self._called("stop", of), gap, kind, restitution, stiffness, damping)

    def backlash(
        self, name: str, of: Expr | float, *, angle: Expr | float, restitution: Expr | float | None = None,
        stiffness: Expr | float | None = None, damping: Expr | float | None = None,
    ) -> None:  # fmt: skip
        """Play: an expression, 0 in its middle, moves freely by `angle` in all [m or rad] between two stops,
        its name with _ahead and _behind; restitution, or stiffness and damping, as of a stop."""
        kind = self._moves(of, "backlash")
        half = self._sized(angle, kind, f"{name}_angle", f"backlash {name}") / 2
        for which, gap in (("ahead", half - of), ("behind", half + of)):
            self._stop(f"{name}_{which}", gap, kind, restitution, stiffness, damping)

    faces: list[tuple[Any, Expr, Any, Any]]  # of contacts: a point, its radius, a line and its length

    def contact(
        self, name: str, first: object, second: object, *, radii: object = (0, 0),
        restitution: Expr | float | None = None, stiffness: Expr | float | None = None,
        damping: Expr | float | None = None, friction: object = None, length: object = None, depth: object = "1 mm",
    ) -> None:  # fmt: skip
        """A point of a link, or a pair (x, y), on the left of a line, or two circles: `radii` of the circles about the
        first and the second point [m]. With a `length` the line ends so far from its point, and is the face of a wall
        as thick as `depth` on its right, which the circle meets from all sides [m]. `friction` is mu, or (mu_s, mu_k),
        against a line of the frame, without restitution."""
        r1, r2 = self._pair(radii, "m", f"radii of {name}", (f"{name}_r1", f"{name}_r2"))
        x, y = self._placed(first, name)
        if length is not None and (not isinstance(second, LinkLine) or r1 == 0 or friction is not None):
            refuse(f"the contact {name!r} has no length; it is of a circle, radii=(r, 0), at a line without friction")
        if not isinstance(second, LinkLine):
            x2, y2 = self._placed(second, name)
            if r1 == r2 == 0:
                refuse(f"the contact {name!r} is of two points; give radii=(r1, r2), or a line")
            gap = sqrt((x - x2) ** 2 + (y - y2) ** 2) - r1 - r2
        else:
            along, across = _along(second, (x, y))
            gap = across - r1 if length is None else self._wall(name, (along, across), (length, depth), r1) - r1
        if friction is not None and not (isinstance(second, LinkLine) and second.link is self.frame):
            refuse(f"the contact {name!r} has friction, which needs a line of the frame; leave friction out")
        if friction is not None and restitution not in (None, 0):
            refuse(f"the contact {name!r} has friction and restitution, whose blow may gain energy; give restitution=0")
        self._stop(name, gap, "m", restitution, stiffness, damping)
        self.faces.append((first, r1, second, length))
        if friction is not None:
            if r1 != 0 and isinstance(first, tuple):
                refuse(f"the contact {name!r} is of a circle whose turn is not known; name a point of a link")
            slides = along + (r1 * point_of(first).link.angle if r1 != 0 else 0)
            self._rub(f"{name}_friction", slides, "m", friction, {"contact": name})

    def _wall(self, name: str, at: Pair, sizes: tuple[object, object], radius: Expr) -> Expr:
        """How far a point is from a wall that begins where a line does [m]; as a circle rolls over its end, the rate
        of its gap has no kink: the way beyond begins softly, over a fiftieth of the radius."""
        soft, square = radius / 50, Integer(0)
        for which, place, size in zip(("along", "across"), (at[0], -at[1]), sizes, strict=True):
            key = "length" if which == "along" else "depth"
            long = self._constant(size, "m", f"{name}_{key}", f"{key} of {name}")
            here = self.let(self.free_name(f"{which}_{name}"), place, "m")
            beyond: list[tuple[Expr, Expr | bool]] = []
            for far in (-here, here - long):
                x = far / soft
                beyond += [(far, far > soft), (soft * x**3 * (6 - 8 * x + 3 * x**2), far > 0)]
            square += self.let(self.free_name(f"beyond_{which}_{name}"), Piecewise(*beyond, (0, True)), "m") ** 2
        return sqrt(square)

    def friction(
        self, of: object, *, mu: object, normal: Expr | float | None = None, radius: Expr | float | None = None,
        stribeck: Expr | float | None = None, viscous: Expr | float | None = None, speed: Expr | float | None = None,
        law: str = "set-valued", smoothing: Expr | float | None = None, name: str = "",
    ) -> None:  # fmt: skip
        """Dry friction in a joint, by its name, or along an expression that `normal` presses [N].

        mu: of sticking and sliding, or both in one [-]; radius: of a pin, or where it is a torque [m]; stribeck: speed
        by which it falls from one to the other; viscous: besides [N*s/m, N*m*s/rad]; speed: of the other face. law:
        `set-valued` sticks, `smooth` never does: it turns about over the speed `smoothing` [m/s, rad/s].
        """
        facts: dict[str, object] = {"law": law}
        if law not in _LAWS:
            refuse(f"law = {law!r} of a friction is not known; there are {', '.join(_LAWS)}")
        if (law == "smooth") != (smoothing is not None):
            refuse("a smooth friction turns about over a speed, smoothing=.., and a set-valued one over none")
        if isinstance(of, str):
            joint = next((j for j in self.link_joints if j.name == of), None)
            if joint is None:
                known = ", ".join(j.name for j in self.link_joints) or "none"
                refuse(f"the friction names the joint {of!r}, which is none; there are {known}")
            if normal is not None:
                refuse(f"the friction of the joint {of!r} is pressed by its reactions; leave normal out")
            slides, facts["reactions"] = self._rubbing(joint)
            label = name or f"friction_{of}"
        else:
            slides, label = of, name or self._called("friction", of)
            if normal is None:
                refuse(f"the friction along {of} is pressed by nothing; give normal=.. in N, or name a joint")
        kind = self._moves(slides, "friction")
        if kind == "rad" and radius is None:
            refuse(f"the friction {label!r} is a torque; give the radius at which it acts")
        if kind == "m" and radius is not None:
            refuse(f"the friction {label!r} acts along a length, which has no radius; leave radius out")
        rate, drag = ("m/s", "N*s/m") if kind == "m" else ("rad/s", "N*m*s/rad")
        sizes = {"normal": (normal, "N"), "radius": (radius, "m"), "stribeck": (stribeck, rate),
                 "viscous": (viscous, drag), "speed": (speed, rate), "smoothing": (smoothing, rate)}  # fmt: skip
        for key, (value, unit) in sizes.items():
            if value is not None:
                facts[key] = self._amount(value, unit, label, key)
        self._rub(label, slides, kind, mu, facts)

    def _rub(self, name: str, slides: Expr, kind: str, mu: object, facts: dict[str, object]) -> None:
        pair = mu if isinstance(mu, (tuple, list)) else (mu, mu)
        if len(pair) != 2:
            refuse(f"mu = {mu!r} of {name!r} must be one value, or two, of sticking and of sliding")
        sticks, slid = (self._amount(v, "-", name, key) for v, key in zip(pair, ("mu_s", "mu_k"), strict=True))
        if all(isinstance(v, (int, float)) for v in pair) and pair[0] < pair[1]:
            refuse(f"the friction {name!r} sticks less than it slides: mu = {mu}; the first is that of sticking")
        acting = self._acts(name, slides, kind)
        self._role("friction", name=name, force=acting, mu_s=sticks, mu_k=slid, **facts)

    def _stop(self, name: str, gap: Expr, kind: str, restitution: object, stiffness: object, damping: object) -> None:
        if (restitution is None) == (stiffness is None):
            refuse(f"the stop {name!r} takes restitution, or stiffness and damping; give one of the two")
        if damping is not None and stiffness is None:
            refuse(f"the stop {name!r} has damping without stiffness; give stiffness too")
        units = {"restitution": "-", "stiffness": f"N*m/{kind}" if kind == "rad" else "N/m", "damping": f"s/{kind}"}
        values = {"restitution": restitution, "stiffness": stiffness, "damping": damping}
        sizes = {k: self._amount(v, units[k], name, k) for k, v in values.items() if v is not None}
        shown = self._shown(gap, f"gap_{name}", kind, 0)
        self._role("stop", name=name, gap=shown, force=self._acts(name, Symbol(shown, real=True), kind), **sizes)

    def _acts(self, name: str, along: Expr, kind: str) -> str:
        """An input of its own by which something acts."""
        self._usable(name)
        acting = self.inputs(self.free_name(f"force_{name}"), "N" if kind == "m" else "N*m")
        self.force(acting, along=along)
        return str(acting)

    def _amount(self, value: object, unit: str, name: str, key: str) -> str:
        """A size of parameters as text; a number must be in its range."""
        if isinstance(value, (int, float)) and not isinstance(value, bool):
            most = 1 if key == "restitution" else float("inf")
            if not 0 <= value <= most and key != "speed":
                refuse(f"{key} = {value} of {name!r} must be 0 or above{', and at most 1' if most == 1 else ''}")
        sized = self._sized(value, unit, f"{name}_{key}", f"{key} of {name}")
        return self._size_of(sized, unit, f"{key} of {name}")

    def _moves(self, of: object, what: str) -> str:
        """The unit of what moves: a length or an angle."""
        value = self._checked(of, "", what)
        if not value.free_symbols & {*self.tape.variables, *self.tape.entries}:
            refuse(f"the {what} is of {of}, which moves with no coordinate; there are {', '.join(map(str, self.q))}")
        known = self.dimension(value)
        if known not in (None, dimensions.PURE, self._unit("m")):
            refuse(f"the {what} is of {of}, which is in {dimensions.in_words(known)}; give a length or an angle")
        return "m" if known == self._unit("m") else "rad"

    def _placed(self, point: object, name: str) -> Pair:
        return self._pair(point, "m", f"point of {name}") if isinstance(point, tuple) else point_of(point).xy

    def _called(self, what: str, of: object) -> str:
        if of not in self.q:
            refuse(f"the {what} of {of} has no name; give name=..")
        return f"{what}_{of}"

    def _rubbing(self, joint: Joint) -> tuple[Expr, list[str]]:
        """How the faces of a joint slide, and the reactions that press them together."""
        if joint.kind == "gear":
            refuse(f"the joint {joint.name!r} is a gear, which has no friction of its own; name a pin, slider or slot")
        first, second = joint.first, joint.second
        turned = second.link.angle - first.link.angle
        names = [self.reaction_of[d].name for d in joint.displacements if d in self.reaction_of]
        if not joint.used:  # it will close by constraint, whose multipliers have these names
            names = [f"R_{axis}_{joint.name}" for axis in ("xy" if joint.kind == "pin" else "n")]
        elif len(names) < len(joint.displacements):
            refuse(
                f"the joint {joint.name!r} has no reaction in closed form yet; declare its friction behind all joints"
            )
        if joint.kind == "pin":
            return turned, names
        line, point = (first, second) if isinstance(first, LinkLine) else (second, first)
        at = point.link.out((point.u, point.v))
        return _along(line, at)[0] * (1 if line is first else -1), names[:1]


def _along(line: LinkLine, point: Pair) -> Pair:
    """Where a point is along a line of a link, and how far on the left of it [m]."""
    line.link.settle()
    (x, y), (x0, y0) = point, line.link.out((line.u, line.v))
    tx, ty = line.link.turn((cos(line.tilt), sin(line.tilt)))
    dx, dy = x - x0, y - y0
    return dx * tx + dy * ty, (dy * tx - dx * ty) if (tx, ty) != (Integer(1), Integer(0)) else dy
