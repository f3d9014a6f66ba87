"""From the text of a formula to a tree. Text is never executed; what is not arithmetic is refused with a reason."""

import ast
import re
import warnings
from collections.abc import Container, Iterable, Iterator, Mapping
from dataclasses import field

from mechsym.audit import limits
from mechsym.audit import tree as trees
from mechsym.audit.functions import MEANINGS, MODULES, meaning
from mechsym.audit.latex import read_latex
from mechsym.audit.printer import to_latex, to_python
from mechsym.audit.spelling import bracketed, from_greek, resolve, unprogrammed
from mechsym.audit.statement import statement
from mechsym.audit.tree import Node
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
RESERVED = (*CONSTANTS, *limits.FUNCTIONS, *_ALIASES, *MEANINGS)
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


class AnyLetter:
    """Every letter, for what is only looked at."""

    def __contains__(self, letter: object) -> bool:
        return True


def read(
    text: str, known: Iterable[str], letters: Mapping[str, str] | None = None, more: Container[str] = ()
) -> Formula:
    """Read a formula in Python syntax or LaTeX.

    Parameters
    ----------
    text : str
        An expression, or `name = expression`
    letters : mapping of str to str, optional
        Author's letter to its expression in known letters
    """
    known = [*known, *CONSTANTS]
    own = {key: read_expression(value, known, more)[0] for key, value in _author_letters(letters or {}).items()}
    said = statement(text)
    if len(said.right) > 1:
        raise BadInput("more than one equals sign; check one equality at a time, as 'name = expression'")
    body, notes = said.right[0], [said.note, *_hidden(own, known)]
    tree, spelled = read_expression(body, [*own, *(k for k in known if k not in own)], more)
    note = "; ".join(n for n in notes if n)
    return Formula(tree=tree, letters=own, latex=is_latex(body), spelled=spelled, note=note)


def read_expression(text: str, known: Iterable[str], more: Container[str] = ()) -> tuple[Node, dict[str, str]]:
    """Read an expression without an equals sign.

    Returns
    -------
    spelled : dict of str to str
        Known letter to the LaTeX that was written for it; empty for Python syntax
    """
    known = list(known)
    if len(text) > MAX_TEXT:
        raise BadInput(f"the formula has {len(text)} characters; at most {MAX_TEXT} are read")
    if not text.strip():
        raise BadInput("the formula is empty; write an expression such as r*sin(phi)")
    tree, spelled = read_latex(text) if is_latex(text) else (_read_python(text), {})
    limits.check(tree)
    meant = {written: _known_letter(written, known, more) for written in trees.letters(tree)}
    tree = trees.substitute(tree, lambda n: trees.name(meant[n.id]) if isinstance(n, ast.Name) else None)
    return tree, {meant[plain]: latex for plain, latex in spelled.items() if plain in meant}


def write(formula: Formula, tree: Node | None = None) -> str:
    """A formula, or an edited tree of it, in its author's form.

    Parameters
    ----------
    tree : Node, optional
        Another tree in the same letters
    """
    tree = formula.tree if tree is None else tree
    return to_latex(tree, formula.spelled) if formula.latex else to_python(tree)


def is_latex(text: str) -> bool:
    """Whether a text is LaTeX rather than Python syntax.

    Returns
    -------
    answer : bool
        True when it has a backslash, a brace or a dollar sign
    """
    return any(mark in text for mark in "\\{}$")


def letter_pairs(text: str) -> dict[str, str]:
    """The value of `--letters`: `R=r1+r2, L=l1+l2`.

    Parameters
    ----------
    text : str
        Pairs separated by commas or semicolons
    """
    found = {}
    for part in filter(None, (p.strip() for p in re.split(r"[,;]", text))):
        key, sign, value = part.partition("=")
        if not sign or not key.strip() or not value.strip():
            raise BadInput(
                f"--letters {part!r} is not LETTER=EXPRESSION; write for example --letters 'R=r1+r2,L=l1+l2'"
            )
        found[key.strip()] = value.strip()
    return found


def _author_letters(letters: Mapping[str, str]) -> dict[str, str]:
    found = {}
    for written, value in letters.items():
        tree = _author_letter(written)
        if not isinstance(tree, ast.Name):
            raise BadInput(f"{written!r} is not a letter; write for example R=r1+r2")
        if tree.id in RESERVED:
            raise BadInput(f"--letters {written!r} cannot be a letter: {tree.id} has its meaning already; name another")
        found[tree.id] = value
    return found


def _author_letter(written: str) -> Node:
    # \\text{stroke length} is one letter, and so is E^*
    if re.fullmatch(r"[^\W\d_]+(?: +[^\W\d_]+)+", written):
        return trees.name(written.replace(" ", ""))
    return read_latex(written)[0] if is_latex(written) or written.endswith("^*") else _read_python(written)


def _hidden(own: Mapping[str, Node], known: list[str]) -> Iterator[str]:
    for letter, tree in own.items():
        if letter in known and not (isinstance(tree, ast.Name) and tree.id == letter):
            yield f"{letter} means {to_python(tree)} here, not the theory's {letter}"


def _known_letter(written: str, known: list[str], more: Container[str]) -> str:
    found = resolve(written, known)
    if found is None and written in more:
        return written
    if found is None:
        raise BadInput(
            f"unknown letter {written[:40]!r}; letters are {', '.join(known)}; name others with --letters 'R=r1+r2'"
        )
    return found


def _read_python(text: str) -> Node:
    source = from_greek(bracketed(unprogrammed(text))).replace("^", "**")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", SyntaxWarning)  # of 2if: what is no formula is refused below
            tree = ast.parse(source.strip(), mode="eval").body
    except (SyntaxError, ValueError) as error:
        reason = getattr(error, "msg", None) or "not an expression"
        told = f"the formula {text.strip()[:60]!r} cannot be read: {reason}{_near(source.strip(), error)}"
        raise BadInput(f"{told}; {_hint(source)}") from None
    except (RecursionError, MemoryError):
        raise BadInput("the formula is nested too deep to be read; split it and check the parts") from None
    limits.check_size(tree)
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
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.UAdd):
        return trees.substitute(node.operand, _tidy)
    if isinstance(node, ast.Attribute) and node.attr.lower() == "pi" and ast.unparse(node.value) in MODULES:
        return trees.name("pi")
    if not isinstance(node, ast.Call):
        return None
    function = _function(node)
    if node.keywords:
        raise BadInput(f"{function}() takes no named arguments here")
    arguments = [trees.substitute(a, _tidy) for a in node.args]
    found = meaning(function, arguments)
    return found if found is not None else _one(function, arguments)


def _one(function: str, arguments: list[Node]) -> Node:
    if len(arguments) != 1:
        raise BadInput(f"{function} takes one argument, not {len(arguments)}; write {function}(a)")
    plain = _ALIASES.get(function, function)
    if plain not in limits.FUNCTIONS and plain.lower() in limits.FUNCTIONS:
        plain = plain.lower()
    if plain not in limits.FUNCTIONS:
        there = ", ".join([*limits.FUNCTIONS, *MEANINGS])
        raise BadInput(
            f"{function[:40]!r} is not a known function; a * is missing behind it if it is a letter; there are {there}"
        )
    return trees.call(plain, arguments[0])


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
    raise BadInput(f"a * is missing behind {after!r}: write {after}*(..)")
