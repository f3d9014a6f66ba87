"""From the text of a formula to a tree. Text is never executed; what is not arithmetic is refused with a reason."""

import ast
import re
import warnings
from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import field
from functools import partial

from mechsym.audit.read import tree as trees
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.letter import ASKED, Ambiguous, Way
from mechsym.audit.read.printed import differential, is_printed, read_printed
from mechsym.audit.read.slopes import slope_in
from mechsym.audit.read.spelling import bracketed, from_greek, resolve, to_latex, to_python, undotted, unprogrammed
from mechsym.audit.read.statement import statement
from mechsym.audit.read.tree import FUNCTIONS, MEANINGS, MODULES, Node, check, check_size, meaning
from mechsym.audit.read.typed import fields
from mechsym.errors import BadInput
from mechsym.quantities import record

MAX_TEXT = 6000
CONSTANTS = ("pi",)
_ALIASES = {
    "arcsin": "asin",
    "arccos": "acos",
    "arctan": "atan",
    "fabs": "abs",
    "tg": "tan",
    "ctg": "cot",
    "ln": "log",
    "Abs": "abs",
}
#: Names of constants and functions: no letter of an author can have one
RESERVED = (*CONSTANTS, *FUNCTIONS, *_ALIASES, *MEANINGS)
# two operands without a sign between them: 2r, (a)b, r sin(phi); not the words of Python
_PRODUCT = re.compile(
    r"(?<![\w.])\d+(?:\.\d+)?\s*[A-Za-z(]|\)\s*[A-Za-z0-9(]|"
    r"\b(?!(?:if|else|for|in|and|or|not|is)\b)\w+\s+(?!(?:if|else|for|in|and|or|not|is)\b)[\w(]"
)


@record
class Formula:
    """A formula as printed, in its author's letters."""

    tree: Node
    letters: Mapping[str, Node] = field(default_factory=dict)  #: Author's letter to its expression in known letters
    latex: bool = False  #: Whether it was written in LaTeX
    spelled: Mapping[str, str] = field(default_factory=dict)  #: Plain name to the author's LaTeX for it
    note: str = ""


def joined(*notes: str) -> str:
    """Notes one behind the other, without those that are empty."""
    return "; ".join(n for n in notes if n)


class UnknownLetter(BadInput):
    """A letter that nothing tells of; `short` without the list of those that are known."""

    def __init__(self, short: str, more: str = "") -> None:
        super().__init__(short + more)
        self.short = short


class AnyLetter:
    """Every letter, for what is only looked at."""

    def __contains__(self, letter: object) -> bool:
        return True


def read(
    text: str,
    known: Iterable[str],
    letters: Mapping[str, str] | None = None,
    more: Container[str] = (),
    way: Way = ASKED,
) -> Formula:
    """Read a formula, in Python, LaTeX or print, an expression or `name = expression`; `letters` are its author's."""
    known = [*known, *CONSTANTS]
    own = _meanings(_author_letters(letters or {}), known, more, way)
    for words in (k for k in letters or {} if re.fullmatch(r"\w+(?: +\w+)+", k)):
        text = text.replace(words, words.replace(" ", ""))
    said = statement(text)
    if len(said.right) > 1:
        raise BadInput("more than one equals sign; check one equality at a time, as 'name = expression'")
    body = said.right[0]
    letters_now = [*own, *(k for k in known if k not in own)]
    rates = _rates(read_expression(body, letters_now, AnyLetter(), way)[0], own, known)
    own |= rates
    tree, spelled = read_expression(body, [*rates, *letters_now], more, way)
    hidden = [k for k, meant in own.items() if k in known and not (isinstance(meant, ast.Name) and meant.id == k)]
    crossed = "x between spaces is a times sign here; write * for a product with the letter x"
    ambiguous = "x" in (*known, *own) and not is_latex(body) and _CROSS.search(body)
    note = joined(
        said.note,
        *[crossed] * bool(ambiguous),
        *(f"{k} means {to_python(own[k])} here, not the theory's {k}" for k in hidden),
    )
    return Formula(tree=tree, letters=own, latex=is_latex(body), spelled=spelled, note=note)


def _meanings(texts: Mapping[str, str], known: Sequence[str], more: Container[str], way: Way) -> dict[str, Node]:
    # in the theory's letters; a meaning may hold other letters of the author
    others = [k for k in texts if k not in known and k not in more]
    own = {
        key: read_expression(text, [*known, *(k for k in others if k != key)], more, way)[0]
        for key, text in texts.items()
    }
    for _ in others:
        own = {key: trees.substitute(tree, partial(_mine, own, others)) for key, tree in own.items()}
    for key, tree in own.items():
        if key in others and {*trees.letters(tree)} & {*others}:
            raise BadInput(f"--letters: the meaning of {key} comes back to {key} itself; give it by other letters")
    return own


def _mine(own: Mapping[str, Node], others: Container[str], node: Node) -> Node | None:
    return own[node.id] if isinstance(node, ast.Name) and node.id in others else None


def _rates(tree: Node, own: Mapping[str, Node], known: Container[str]) -> dict[str, Node]:
    r"""What \frac{d\theta}{dt} and \frac{d^2\theta}{dt^2} mean where theta is a coordinate, or a letter for one."""
    rates: dict[str, Node] = {}
    for written in trees.letters(tree):
        slope = slope_in(written, "t")
        if slope and slope.order < 3 and written not in own and written not in known:
            meant = own.get(slope.of, trees.name(slope.of))
            rate = f"{meant.id}{'d' * slope.order}" if isinstance(meant, ast.Name) else ""
            rates |= {written: trees.name(rate)} if rate in known else {}
    return rates


_KEPT = 16
_LONG_NUMBER = re.compile(r"\d*\.\d{17,}")


def read_expression(
    text: str, known: Iterable[str], more: Container[str] = (), way: Way = ASKED
) -> tuple[Node, dict[str, str]]:
    """Read an expression: the tree, and known letters to the LaTeX that was written for them."""
    known = list(known)
    if len(text) > MAX_TEXT:
        raise BadInput(f"the formula has {len(text)} characters; at most {MAX_TEXT} are read")
    if not text.strip():
        raise BadInput("the formula is empty; write an expression such as r*sin(phi)")
    for number in _LONG_NUMBER.findall(text):
        if len(repr(float(number))) < _KEPT:  # 0.99999999999999999999 would be 1
            raise BadInput(f"the number {number[:40]} has more digits than the {_KEPT} that are kept; round it")
    tree, spelled = _read_either(text, known, more, way)
    check(tree)
    meant = {}
    for written in trees.letters(tree):
        letter = resolve(written, known)
        if letter is None and written not in more:
            hint = "name others with --letters 'R=r1+r2'"
            if written.endswith("prime"):
                hint = f"a prime makes another letter: {hint}, or write \\frac{{dx}}{{d\\varphi}} for a derivative"
            there = f"; letters are {', '.join(known)}; {hint}"
            raise UnknownLetter(f"unknown letter {written[:40]!r}", there)
        meant[written] = letter or written
    tree = trees.substitute(tree, lambda n: trees.name(meant[n.id]) if isinstance(n, ast.Name) else None)
    return tree, {meant[plain]: latex for plain, latex in spelled.items() if plain in meant}


def write(formula: Formula, tree: Node | None = None) -> str:
    """A formula, or another tree in its letters, in its author's form."""
    tree = formula.tree if tree is None else tree
    return to_latex(tree, formula.spelled) if formula.latex else to_python(tree)


def is_latex(text: str) -> bool:
    """Whether a text has a backslash, a brace or a dollar sign."""
    return any(mark in text for mark in "\\{}$")


def letter_pairs(text: str) -> dict[str, str]:
    """The value of `--letters`: `R=r1+r2, L=l1+l2`, by commas or semicolons."""
    pairs: dict[str, str] = {}
    for part in filter(None, (p.strip() for p in re.split(r"[,;]", text))):
        key, sign, value = part.partition("=")
        if not sign or not key.strip() or not value.strip():
            raise BadInput(
                f"--letters {part!r} is not LETTER=EXPRESSION; write for example --letters 'R=r1+r2,L=l1+l2'"
            )
        if pairs.setdefault(key.strip(), value.strip()) != value.strip():
            raise BadInput(
                f"--letters gives {key.strip()} two meanings, {pairs[key.strip()]} and {value.strip()}; keep one"
            )
    return pairs


def _author_letters(letters: Mapping[str, str]) -> dict[str, str]:
    meanings = {}
    for key, value in letters.items():
        written = fields(undotted(key)).strip()
        # \\text{stroke length} is one letter, and so is E^*
        if re.fullmatch(r"[^\W\d_]+(?: +[^\W\d_]+)+", written):
            tree: Node = trees.name(written.replace(" ", ""))
        elif rate := differential(written):
            tree = trees.name(rate)
        elif re.fullmatch(r"[^\W\d]\w*\*", written):
            tree = trees.name(from_greek(written[:-1]).replace("_", "") + "star")
        elif is_latex(written) or written.endswith(("^*", "'", "′", "″")):
            tree = read_latex(written)[0]
        else:
            tree = _read_python(written)
        if not isinstance(tree, ast.Name):
            raise BadInput(f"{written!r} is not a letter; write for example R=r1+r2")
        if tree.id in RESERVED:
            raise BadInput(f"--letters {written!r} cannot be a letter: {tree.id} has its meaning already; name another")
        meanings[tree.id] = value
    return meanings


_PRIME, _QUOTED = re.compile(r"(?<=\w)'"), re.compile(r"(?<![\w'])'")
_CROSS = re.compile(r"(?<=[\w)])\s+x\s+(?=[\w(])")  # 2 x a, which no formula of letters and signs is


class _NoProgram(BadInput):
    """What no program holds and a page may print; `function` is what is called and is none."""

    def __init__(self, why: str, function: str = "") -> None:
        super().__init__(why)
        self.function = function


def _read_either(text: str, known: Sequence[str], more: Container[str], way: Way) -> tuple[Node, dict[str, str]]:
    if re.search(r"[\\$]", text):
        return read_latex(text, way=way)
    braces = is_latex(text)
    try:
        tree, spelled = read_latex(text, way=way) if braces else (_read_python(text), {})
        if all(resolve(letter, known) or letter in more for letter in trees.letters(tree)):
            return tree, spelled
    except BadInput as error:
        printed = _printed(text, known, way) if braces or isinstance(error, _NoProgram) else None
        called = error.function if isinstance(error, _NoProgram) else ""
        strange = called and resolve(called, known) is None and called not in more
        if printed is None or strange and called in trees.letters(printed):
            raise
        return printed, {}
    # e^{..} in a text of signs, and mz for m z
    printed = _printed(text, known, way)
    better = printed is not None and (braces or all(resolve(n, known) or n in more for n in trees.letters(printed)))
    return (printed, {}) if printed is not None and better else (tree, spelled)


def _printed(text: str, known: Sequence[str], way: Way) -> Node | None:
    if not is_printed(text):
        return None
    try:
        return read_printed(text, known, way)
    except Ambiguous:
        raise
    except BadInput:
        return None


def _read_python(text: str) -> Node:
    source = from_greek(bracketed(unprogrammed(text))).replace("^", "**")
    source = source if _QUOTED.search(source) else _PRIME.sub("prime", source)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)  # of 2if: what is no formula is refused below
            tree = ast.parse(_CROSS.sub("*", source).strip(), mode="eval").body
    except (SyntaxError, ValueError) as error:
        reason = getattr(error, "msg", None) or "not an expression"
        message = f"the formula {text.strip()[:60]!r} cannot be read: {reason}{_near(source.strip(), error)}"
        kind = _NoProgram if isinstance(error, SyntaxError) else BadInput
        raise kind(f"{message}; {_hint(source)}") from None
    except (RecursionError, MemoryError):
        raise BadInput("the formula is nested too deep to be read; split it and check the parts") from None
    check_size(tree)
    return trees.substitute(tree, _tidy)


def _near(source: str, error: Exception) -> str:
    if not isinstance(error, SyntaxError) or error.offset is None or (error.lineno or 1) > 1:
        return ""
    at = min(max(error.offset - 1, 0), len(source))
    return f" near {source[max(0, at - 8) : at + 8]!r}"


def _hint(source: str) -> str:
    missing = _PRODUCT.search(source)
    if missing is None:
        return "write letters, numbers, + - * / ^, functions, and brackets in pairs, as in r*sin(phi)"
    before, after = source[: missing.end() - 1].rstrip()[-12:], source[missing.end() - 1 :][:12]
    return f"a * is missing between {before!r} and {after!r}: write products with *, as in 2*r"


def _tidy(node: Node) -> Node | None:
    if isinstance(node, ast.List | ast.Tuple | ast.Subscript):
        raise _NoProgram(
            f"{ast.unparse(node)[:40]!r} is not arithmetic; round brackets group, a point is that of a number"
        )
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd):
        return trees.substitute(node.operand, _tidy)
    if isinstance(node, ast.Attribute) and node.attr.lower() == "pi" and ast.unparse(node.value) in MODULES:
        return trees.name("pi")
    if not isinstance(node, ast.Call):
        return None
    function = _spelled(_function(node))
    if node.keywords:
        raise BadInput(f"{function}() takes no named arguments here")
    arguments = [trees.substitute(a, _tidy) for a in node.args]
    several = meaning(function, arguments)
    if several is not None:
        return several
    if len(arguments) != 1:
        raise BadInput(f"{function} takes one argument, not {len(arguments)}; write {function}(a)")
    plain = _ALIASES.get(function, function)
    if plain not in FUNCTIONS:
        there = ", ".join([*FUNCTIONS, *MEANINGS])
        why = (
            f"{function[:40]!r} is not a known function; a * is missing behind it if it is a letter; there are {there}"
        )
        raise _NoProgram(why, function)
    return trees.call(plain, arguments[0])


def _spelled(function: str) -> str:
    # SIN, DSIN and Sin
    words = (*FUNCTIONS, *_ALIASES, *MEANINGS)
    return next((w for w in (function, function.lower(), function.lower().removeprefix("d")) if w in words), function)


def _function(node: ast.Call) -> str:
    if isinstance(node.func, ast.Name):
        return node.func.id
    if isinstance(node.func, ast.Attribute):
        module = ast.unparse(node.func.value)
        if module.split(".")[0] in MODULES:
            return node.func.attr
        raise BadInput(f"{ast.unparse(node.func)[:40]!r} is not a known function; write sin, np.sin or math.sin")
    after = ast.unparse(node.func)[:40]
    after = after if isinstance(node.func, ast.Call | ast.Constant) else f"({after})"
    raise _NoProgram(f"a * is missing behind {after!r}: write {after}*(..)")
