"""Values that follow from others at every point of a sweep: `chamber.bore=sqrt(4*V/(pi*4*parameters.e))`.

A name is a key of the case (SI, of this point), pi, or a letter that a tie before it defines: `V=2.94e-4`.
"""

import ast
import math
import operator
from collections.abc import Callable, Mapping

from mechsym import cases
from mechsym.cases import Case
from mechsym.cases.values import Place
from mechsym.errors import BadInput, shown, suggest
from mechsym.files import Json
from mechsym.quantities import parse, record
from mechsym.sweep.axes import Value

_OPERATORS: dict[type, Callable[..., float]] = {
    ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv,
    ast.Pow: operator.pow, ast.USub: operator.neg, ast.UAdd: operator.pos,
}  # fmt: skip
_FUNCTIONS: dict[str, Callable[..., float]] = {
    name: getattr(math, name)
    for name in ("sqrt", "exp", "log", "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh")
} | {"abs": abs, "min": min, "max": max}


@record
class Tie:
    """One value that follows from others."""

    key: str  #: As it was written
    text: str  #: Formula, SI
    place: Place | None  #: Where the value belongs; None for a letter
    tree: ast.expr


@record
class Ties:
    """What ties need at every point."""

    base: Case
    ties: tuple[Tie, ...]
    #: Keys of the axes and of the formulas by the way they are written
    places: Mapping[str, Place]

    def at(self, here: Mapping[str, Value]) -> Json:
        """Values of a point with those that are tied.

        here: values of the axes, as `--set` takes them. Returns values: `here` and every tied value by `section.field`
        [SI]. Raises BadInput: a formula has no value here.
        """
        values: dict[str, Value] = {
            _name(self.places[key]): _si(self.places[key], value) for key, value in here.items()
        }
        found = dict(here)
        for tie in self.ties:
            values[tie.key if tie.place is None else _name(tie.place)] = value = self._value(tie, values)
            if tie.place is not None:
                found[_name(tie.place)] = value
        return found

    def _value(self, tie: Tie, values: Mapping[str, Value]) -> float:
        try:
            value = _worked_out(tie.tree, lambda name: self._of(name, values))
        except (ArithmeticError, ValueError) as error:
            raise BadInput(f"--tie {tie.key} = {tie.text} has no value here: {error}") from None
        if isinstance(value, complex) or not math.isfinite(value):
            raise BadInput(f"--tie {tie.key} = {tie.text} has no value here: {value}")
        return float(value)

    def _of(self, name: str, values: Mapping[str, Value]) -> float:
        if name not in self.places:
            return math.pi if name == "pi" and name not in values else float(values[name])
        place = self.places[name]
        value = values.get(_name(place))
        if value is None:
            value = getattr(self.base.need(place.section), place.field, None)
        if value is None or isinstance(value, str | tuple):
            raise BadInput(f"--tie: {name} = {shown(value)} is no number to reckon with")
        return float(value)


def ties(case: str, overrides: Mapping[str, object], texts: tuple[str, ...], axes: Mapping[str, Place]) -> Ties:
    """Ties that are written KEY=FORMULA.

    axes: keys that the sweep runs over. Raises BadInput: no formula, a name that neither the case nor a tie before it
    has, or a letter that nothing uses.
    """
    places, letters, found = dict(axes), {"pi"}, []
    for text in texts:
        key, tree, written = _split(text)
        place = _located(case, key, overrides)
        for name in _names(tree):
            if name not in letters and name not in places:
                places[name] = _number(cases.locate(case, name, overrides, option=f"--tie {key}:"), name)
        if place is None:
            letters.add(key)
        found.append(Tie(key=key, text=written, place=place, tree=tree))
    used = {name for tie in found for name in _names(tie.tree)}
    for tie in found:
        if tie.place is None and tie.key not in used:
            cases.locate(case, tie.key, overrides, option="--tie")
    return Ties(base=cases.load(case, overrides), ties=tuple(found), places=places)


def _split(text: str) -> tuple[str, ast.expr, str]:
    key, sign, formula = (part.strip() for part in text.partition("="))
    if not sign or not key or not formula:
        raise BadInput(f"--tie {shown(text)} is not KEY=FORMULA; write for example --tie 'bore=sqrt(4*V/(pi*stroke))'")
    try:
        tree = ast.parse(formula.replace("^", "**"), mode="eval").body
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        raise BadInput(
            f"--tie {key}: {shown(formula)} is no formula; write for example sqrt(4*V/(pi*stroke))"
        ) from None
    _checked(key, tree)
    return key, tree, formula


def _checked(key: str, tree: ast.expr) -> None:
    """Refuse what a formula cannot be made of."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Call):
            name = ast.unparse(node.func)
            if name not in _FUNCTIONS or node.keywords:
                raise BadInput(f"--tie {key}: {shown(name)} is no function; {suggest(name, _FUNCTIONS)}")
        elif isinstance(node, ast.Constant):
            if isinstance(node.value, bool) or not isinstance(node.value, int | float):
                raise BadInput(f"--tie {key}: {shown(node.value)} is no number")
        elif isinstance(node, ast.BinOp | ast.UnaryOp):
            if type(node.op) not in _OPERATORS:
                raise BadInput(f"--tie {key}: {shown(ast.unparse(node))} is no sum, product or power")
        elif not isinstance(node, ast.Name | ast.Attribute | ast.operator | ast.unaryop | ast.expr_context):
            raise BadInput(f"--tie {key}: {shown(ast.unparse(node))} has no place in a formula")


def _names(tree: ast.expr) -> list[str]:
    """Names that a formula reckons with: letters and dotted keys, not its functions."""
    if isinstance(tree, ast.Name | ast.Attribute):
        return [ast.unparse(tree)]
    parts = tree.args if isinstance(tree, ast.Call) else ast.iter_child_nodes(tree)
    return [name for part in parts if isinstance(part, ast.expr) for name in _names(part)]


def _worked_out(tree: ast.expr, of: Callable[[str], float]) -> float:
    if isinstance(tree, ast.Constant) and isinstance(tree.value, int | float):
        return tree.value
    if isinstance(tree, ast.Name | ast.Attribute):
        return of(ast.unparse(tree))
    if isinstance(tree, ast.BinOp):
        return _OPERATORS[type(tree.op)](float(_worked_out(tree.left, of)), float(_worked_out(tree.right, of)))
    if isinstance(tree, ast.UnaryOp):
        return _OPERATORS[type(tree.op)](_worked_out(tree.operand, of))
    assert isinstance(tree, ast.Call) and isinstance(tree.func, ast.Name)
    return _FUNCTIONS[tree.func.id](*(_worked_out(part, of) for part in tree.args))


def _located(case: str, key: str, overrides: Mapping[str, object]) -> Place | None:
    """Where a tied value belongs; None for a plain name that the case does not have."""
    try:
        return _number(cases.locate(case, key, overrides, option="--tie"), key)
    except BadInput:
        if not key.isidentifier() or key in _FUNCTIONS or key == "pi":
            raise
        return None


def _number(place: Place, key: str) -> Place:
    if place.unit is None:
        raise BadInput(f"--tie: {key} is a word, no number")
    return place


def _name(place: Place) -> str:
    return f"{place.section}.{place.field}"


def _si(place: Place, value: Value) -> Value:
    """A value of an axis in SI; a word as it is."""
    if place.unit is None:
        return value
    return parse(f"{value} {place.written}" if place.written else value, place.unit, _name(place))
