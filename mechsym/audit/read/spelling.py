r"""Letters as authors spell them (`\varphi_0`, `φ0` and `phi_0` are all `phi0`), and formulas back as text."""

import ast
import re
import unicodedata
from collections.abc import Iterable, Mapping

from mechsym.audit.read.tree import Node, function_of
from mechsym.errors import BadInput

#: Digits above and below the line
RAISED, LOWERED = "⁰¹²³⁴⁵⁶⁷⁸⁹", "₀₁₂₃₄₅₆₇₈₉"
_GREEK = {
    "α": "alpha", "β": "beta", "γ": "gamma", "δ": "delta", "ε": "epsilon", "ζ": "zeta", "η": "eta", "θ": "theta",
    "κ": "kappa", "λ": "lam", "μ": "mu", "ν": "nu", "ξ": "xi", "π": "pi", "ρ": "rho", "σ": "sigma", "τ": "tau",
    "φ": "phi", "ϕ": "phi", "χ": "chi", "ψ": "psi", "ω": "omega", "Δ": "Delta", "Σ": "Sigma", "Φ": "Phi",
    "Ψ": "Psi", "Ω": "Omega", "Γ": "Gamma", "Θ": "Theta", "Λ": "Lambda", "ℓ": "ell", "·": "*", "×": "*", "−": "-",
    "√": "sqrt", **{c: f"**{n}" for n, c in enumerate(RAISED)}, **{c: f"_{n}" for n, c in enumerate(LOWERED)},
}  # fmt: skip
ALIASES = {"lambda": "lam", "varphi": "phi", "vartheta": "theta", "varepsilon": "epsilon", "varrho": "rho"}
_LATEX = {
    "lam": r"\lambda", "phi": r"\varphi", "epsilon": r"\varepsilon", **{
        n: rf"\{n}" for n in (
            "alpha", "beta", "gamma", "delta", "zeta", "eta", "theta", "kappa", "mu", "nu", "xi", "pi", "rho", "sigma",
            "tau", "chi", "psi", "omega", "Delta", "Sigma", "Phi", "Psi", "Omega", "Gamma", "Theta", "Lambda",
            "Pi", "ell",
        )
    },
}  # fmt: skip
_WORD = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
_STEMS = "|".join([*sorted(_LATEX, key=len, reverse=True), "[A-Za-z]"])
# an index of one letter or of capitals and digits may have dots behind it; a word that ends in d (mixed, rod) has none
_INDEX = r"(?P<digits>[A-Z]*[0-9]+)|_(?P<word>(?:[A-Za-z]|[A-Z0-9]+)(?=dd?\Z)|[A-Za-z0-9]+)"
NAME = re.compile(rf"(?P<stem>{_STEMS})(?:{_INDEX})?(?P<dots>dd?)?")


#: Letter by its name
SYMBOLS = {name: sign for sign, name in _GREEK.items() if name.isalpha() and name != "sqrt" and sign != "ϕ"}
SPEEDS = ("omega", "Omega", "w")  #: Usual letters of an angular speed
_CALLS = "arcsin|arccos|arctan|asin|acos|atan|sqrt|sin|cos|tan|cot|tg|ctg|exp|log|ln"
_BARE = re.compile(rf"\b({_CALLS})\s+((?:\d+(?:\.\d+)?\s*\*?\s*)?[^\W\d]\w*)(?!\s*\()")
_POWERED = re.compile(rf"\b({_CALLS})\s*(?:(²|³|⁴)|(?:\^|\*\*)\s*\{{?\(?(-?\d)\)?\}}?)\s*(?=[^\W\d]|\()")


# operations element by element, Scilab's %pi, a root's sign in front of a bare letter
_PROGRAMS = (
    (re.compile(r"\.(?=[*/^])"), ""),
    (re.compile(r"%(?=pi\b)"), ""),
    (re.compile(r"√\s*([^\W_]\w*)"), r"√(\1)"),
)


def unprogrammed(text: str) -> str:
    """What only programs write, as a formula has it: `a.*b` is `a*b`."""
    for pattern, instead in _PROGRAMS:
        text = pattern.sub(instead, text)
    return text


def bracketed(text: str) -> str:
    """`sin²(φ)` as `sin(φ)**2`, `cos φ` as `cos(φ)`."""
    while match := _POWERED.search(text):
        power = {"²": "2", "³": "3", "⁴": "4"}.get(match[2] or "", match[3] or "")
        end = _argument_end(text, match.end())
        inside = text[match.end() : end]
        if power.startswith("-") or not inside:
            break
        inner = inside if inside.startswith("(") else f"({inside})"
        text = f"{text[: match.start()]}{match[1]}{inner}**{power}{text[end:]}"
    return _BARE.sub(lambda m: f"{m[1]}({_joined(m[2])})", text)


def _joined(argument: str) -> str:
    return re.sub(r"^(\d+(?:\.\d+)?)\s*\*?\s*", r"\1*", argument)


def _argument_end(text: str, start: int) -> int:
    if text[start : start + 1] != "(":
        word = re.compile(r"[^\W\d]\w*").match(text, start)
        return word.end() if word else start
    depth = 0
    for i in range(start, len(text)):
        depth += {"(": 1, ")": -1}.get(text[i], 0)
        if depth == 0:
            return i + 1
    return start


def from_greek(text: str) -> str:
    """Greek letters and typographic signs as Python reads them: `phi` for φ, `lam` for λ and `lambda`."""
    text = "".join(f"{_GREEK[c]}" if c in _GREEK else c for c in text)
    return _WORD.sub(lambda m: ALIASES.get(m[0], m[0]), text)


_MARKS = {"−": "-", "–": "-", "′": "'", "’": "'", "″": "''"}


def typeset(text: str) -> str:
    """Dashes, primes and raised digits as LaTeX has them: s″, x² and t⁻¹ are s'', x^{2} and t^{-1}."""
    raised = {**{sign: str(n) for n, sign in enumerate(RAISED)}, "⁻": "-"}
    text = re.sub(f"[{RAISED}⁻]+", lambda m: f"^{{{''.join(raised[c] for c in m[0])}}}", text)
    return re.sub("|".join(_MARKS), lambda m: _MARKS[m[0]], text)


_DOTTED = re.compile("([^\\W\\d_])(\u0307|\u0308)")


def undotted(text: str) -> str:
    """Rates that are typed with dots above: `ẋ` is xd."""
    spread = unicodedata.normalize("NFD", text)
    dots = {"\u0307": "d", "\u0308": "dd"}
    return _DOTTED.sub(lambda m: f" {from_greek(m[1])}{dots[m[2]]} ", spread) if _DOTTED.search(spread) else text


def plain(base: str, subscript: str = "", dots: int = 0) -> str:
    """A letter's plain name from what LaTeX spells out; p_i is not the constant, and l_n no logarithm."""
    stem, index = ALIASES.get(base, base), re.sub(r"[\W_]", "", re.sub(r"-(?=\d)", "m", subscript))  # y_{i-1}, y_{i+1}
    apart = "_" if index and re.fullmatch(rf"pi|{_CALLS}", stem + index) else ""
    return f"{stem}{apart}{index}{'d' * dots}"


def resolve(written: str, known: Iterable[str]) -> str | None:
    """The known letter that a written one means, if any; underscores do not matter."""
    known = list(known)
    if written in known:
        return written
    alike = [k for k in known if k.replace("_", "") == written.replace("_", "") and k != "pi"]
    if len(alike) > 1:
        raise BadInput(f"the letter {written!r} may mean {' or '.join(alike)}; write the one you mean")
    return alike[0] if alike else None


def latex(name: str) -> str:
    r"""A plain name as LaTeX."""
    match = NAME.fullmatch(name)
    if match is None:
        word = name.replace("_", r"\_")
        return rf"\mathrm{{{word}}}"
    stem, index, dots = match["stem"], match["digits"] or match["word"], match["dots"]
    base = _LATEX.get(stem, stem)
    if dots:
        base = rf"\{dots}ot{{{base}}}"
    return f"{base}_{{{index}}}" if index else base


SUM, PRODUCT, _SIGN, POWER, ATOM = range(5)  # how tightly a printed node binds
_NAMES = {"asin": "arcsin", "acos": "arccos", "atan": "arctan", "log": "ln"}


def to_python(tree: Node) -> str:
    """A formula as Python text, which reads back to the same tree."""
    return _python(tree)[0]


_SIGNS = {ast.Add: (" + ", SUM), ast.Sub: (" - ", SUM), ast.Mult: ("*", PRODUCT), ast.Div: ("/", PRODUCT)}


def _python(node: Node) -> tuple[str, int]:
    if isinstance(node, ast.Name):
        return node.id, ATOM
    if isinstance(node, ast.Constant):
        return str(node.value), ATOM
    if isinstance(node, ast.Call):
        return f"{function_of(node)}({_python(node.args[0])[0]})", ATOM
    if isinstance(node, ast.UnaryOp):
        return f"-{_bracketed(node.operand, POWER)}", _SIGN
    if isinstance(node, ast.IfExp):
        return f"piecewise({', '.join(_python(n)[0] for n in (node.test, node.body, node.orelse))})", ATOM
    if isinstance(node, ast.Compare):
        return f"{_python(node.left)[0]} {SIDES[type(node.ops[0])]} {_python(node.comparators[0])[0]}", SUM
    assert isinstance(node, ast.BinOp)
    if isinstance(node.op, ast.Pow):
        return f"{_bracketed(node.left, ATOM)}**{_bracketed(node.right, ATOM)}", POWER
    sign, level = _SIGNS[type(node.op)]
    # a signed factor may only lead, and what follows - or / needs its own bracket
    following = level + 1 if isinstance(node.op, (ast.Sub, ast.Mult, ast.Div)) else level
    right = _bracketed(node.right, following if following != _SIGN else POWER)
    return f"{_bracketed(node.left, level)}{sign}{right}", level


SIDES: dict[type, str] = {ast.Lt: "<", ast.LtE: "<=", ast.Gt: ">", ast.GtE: ">="}


def _bracketed(node: Node, level: int) -> str:
    text, tightness = _python(node)
    return text if tightness >= level else f"({text})"


def to_latex(tree: Node, spelled: Mapping[str, str]) -> str:
    """A formula as LaTeX, its letters as the author spelled them."""
    return _latex(tree, spelled)[0]


def _latex(node: Node, spelled: Mapping[str, str]) -> tuple[str, int]:
    if isinstance(node, ast.Name):
        return spelled.get(node.id) or latex(node.id), ATOM
    if isinstance(node, ast.Constant):
        text = str(node.value)
        if "e" not in text:
            return text, ATOM
        mantissa, _, exponent = text.partition("e")
        return rf"{mantissa} \cdot 10^{{{int(exponent)}}}", PRODUCT
    if isinstance(node, ast.UnaryOp):
        inner, negated = _latex(node.operand, spelled)[0], node.operand
        if inner.startswith("-") and not (isinstance(negated, ast.BinOp) and isinstance(negated.op, ast.Add | ast.Sub)):
            return inner[1:], PRODUCT
        return f"-{_at_least(node.operand, POWER, spelled)}", SUM
    if isinstance(node, ast.Call):
        function, argument = str(function_of(node)), node.args[0]
        if function == "sqrt":
            return rf"\sqrt{{{_latex(argument, spelled)[0]}}}", ATOM
        if function == "abs":
            return rf"\left|{_latex(argument, spelled)[0]}\right|", ATOM
        if function == "sum":
            return rf"\left(\sum {_at_least(argument, PRODUCT, spelled)}\right)", ATOM
        inner, tightness = _latex(argument, spelled)
        short = tightness == ATOM and isinstance(argument, ast.Name)
        return rf"\{_NAMES.get(function, function)}" + (f" {inner}" if short else rf"\left({inner}\right)"), ATOM
    if isinstance(node, ast.IfExp):
        test, body, other = (_latex(n, spelled)[0] for n in (node.test, node.body, node.orelse))
        return rf"\begin{{cases}} {body} & {test} \\ {other} & \text{{else}} \end{{cases}}", ATOM
    if isinstance(node, ast.Compare):
        left, right = (_latex(n, spelled)[0] for n in (node.left, node.comparators[0]))
        return f"{left} {SIDES[type(node.ops[0])]} {right}", SUM
    assert isinstance(node, ast.BinOp)
    return _operation(node, spelled)


def _at_least(node: Node, level: int, spelled: Mapping[str, str]) -> str:
    text, tightness = _latex(node, spelled)
    return text if tightness >= level else rf"\left({text}\right)"


def _operation(node: ast.BinOp, spelled: Mapping[str, str]) -> tuple[str, int]:
    if isinstance(node.op, ast.Div):
        if isinstance(node.right, ast.Constant) and node.right.value == 1:
            return _latex(node.left, spelled)
        return rf"\frac{{{_latex(node.left, spelled)[0]}}}{{{_latex(node.right, spelled)[0]}}}", ATOM
    if isinstance(node.op, ast.Pow):
        return _power(node, spelled), POWER
    if isinstance(node.op, ast.Mult):
        # -a b: the sign of the first factor needs no bracket where the product leads
        first = node.left
        while isinstance(first, ast.BinOp) and isinstance(first.op, ast.Mult):
            first = first.left
        signed = isinstance(first, ast.UnaryOp)
        left = _at_least(node.left, SUM if signed else PRODUCT, spelled)
        right = _at_least(node.right, POWER, spelled)
        apart = left[-1:].isdigit() and right[:1].isdigit() or _ends_bare(node.left)
        return f"{left} \\cdot {right}" if apart else f"{left} {right}", SUM if signed else PRODUCT
    sign = "+" if isinstance(node.op, ast.Add) else "-"
    right = _at_least(node.right, PRODUCT, spelled)
    return f"{_latex(node.left, spelled)[0]} {sign} {right}", SUM


def _ends_bare(node: Node) -> bool:
    # after \sin\varphi a letter would join the argument
    while isinstance(node, ast.BinOp) and isinstance(node.op, (ast.Mult, ast.Pow)):
        node = node.right if isinstance(node.op, ast.Mult) else node.left
    return isinstance(node, ast.Call) and isinstance(node.args[0], ast.Name)


def _power(node: ast.BinOp, spelled: Mapping[str, str]) -> str:
    exponent = _latex(node.right, spelled)[0]
    function = function_of(node.left)
    if isinstance(node.left, ast.Call) and function not in ("sqrt", "abs", "sum") and exponent != "-1":
        head, _, tail = _latex(node.left, spelled)[0].partition(str(_NAMES.get(str(function), function)))
        return rf"{head}{_NAMES.get(str(function), function)}^{{{exponent}}}{tail}"
    base, level = _latex(node.left, spelled)
    simple = level == ATOM and isinstance(node.left, (ast.Name, ast.Constant))
    return f"{base}^{{{exponent}}}" if simple else rf"\left({base}\right)^{{{exponent}}}"
