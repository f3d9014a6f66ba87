r"""What the equations of a whole text say, side by side, in one spelling of its letters.

A text has its own words: `CR` is one letter where a table names it, `S(\theta)` is S, `Q_2^3` the heat from 2 to 3.
"""

import ast
import re
from bisect import bisect_right
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from itertools import islice
from zlib import crc32

from mechsym.audit.read.clause import OPENED
from mechsym.audit.read.displays import MOST, Displayed, displayed, flattened
from mechsym.audit.read.lagrange import LagrangeEquation, calligraphic, lagrange_equation
from mechsym.audit.read.latex import read_latex
from mechsym.audit.read.macros import expanded
from mechsym.audit.read.nomenclature import Named, called, nomenclature, with_marks
from mechsym.audit.read.refused import NO_LETTERS, SIGN, matrices_of, refused
from mechsym.audit.read.spelling import SYMBOLS
from mechsym.audit.read.statement import statement, unapplied
from mechsym.audit.read.subject import behind, listed, shared, subject
from mechsym.audit.read.tree import (
    Node,
    argument_of,
    binary,
    call,
    check,
    function_of,
    is_operation,
    number,
    value_of,
)
from mechsym.audit.read.tree import name as name_of
from mechsym.errors import BadInput
from mechsym.quantities import record

_ANGLES = r"\\(?:theta|vartheta|varphi|phi|alpha|psi)"
_APPLIED = re.compile(
    rf"(?P<of>[A-Za-z}}'])\s*(?:\\left)?\(\s*(?:{_ANGLES}(?:_\{{?\w+\}}?)?|t)\s*(?:\\right)?\)(?!\s*\^)"
)
_DEFINED = re.compile(rf"((?:\\Delta ?)?{SIGN}) ?\( ?({SIGN}(?: ?, ?{SIGN})*) ?\)")
# the imaginary unit, the gamma function, and the mean or the transform of what stands in braces
_NO_PRODUCT = re.compile(
    r"\\(?:text|mathrm|rm)\s*\{?\s*[ij]\s*\}|\\Gamma\s*(?:\\left)?\("
    r"|(?:(?<![A-Za-z])E|\\math(?:cal|bb|scr)\s*\{?\s*[A-Z]\s*\}?)\s*(?:\\left)?\s*\\\{"
)
_END = re.compile(r"\$\$|\\end\{[a-z]+\*?\}|\\\]")  # of a display
_CLOSED = re.compile(r"(?:\\end\{[a-z]+\*?\}|\$\$|\\\])$")  # where a display ends
_SECTION = re.compile(r"^(?:\s*\\(?:sub)*section\b|#+\s|\d+(?:\.\d+)+\.?\s+[A-Z]|\*\*[^*\n$]{3,60}\*\*\s*$)", re.M)
_BRACKETS = re.compile(r"(?<!\\)\\[()]")  # the other way to write a formula within a line
_INLINE = re.compile(r"(?<![\\$])\$([^$\n]{1,200}?)\$(?!\$)")
_RATIO = re.compile(rf"(?:\bratio,?\s+(?:=\s*)?|^)\$\s*({SIGN}\s*/\s*{SIGN})\s*\$$")
_ALONE = re.compile(r"^[ \t]*(\$[^$\n]+\$)[ \t]*[.,;]?[ \t]*$", re.MULTILINE)  # a display
_INDEXED = re.compile(r"([A-Z])_(\d|\{\d\})\^(\d|\{\d\})")
_NO_EQUATION = re.compile(r"\\(?:to|rightarrow|longrightarrow|le|leq|ge|geq|ll|gg|neq|in|propto|sim)(?![A-Za-z])|[<>]")
_TIDY = (
    (re.compile(r"\\(?:left|right)\s*\."), " "),
    (re.compile(r"\\mathrm\s*\{\s*d\s*\}"), "d"),
    (re.compile(r"(?<=\d),\s(?=\d)"), "."),
    (re.compile(r"\\(?:mathbf|mathsf|mathit|boldsymbol|bm|vec|mathrm|rm)\s*(?=[A-Za-z\\])"), " "),
    (re.compile(r"(?<![A-Za-z\\{])const(?:ant)?\b\.?"), r"\\text{constant}"),
    (re.compile(r"(?<![\\A-Za-z])f\s*\([^()=]*,[^()=]*\)|(?<==)\s*f\s*\([^()=]*\)\s*$"), r"\\text{function}"),
    (re.compile(r"\\[lr]vert(?![A-Za-z])"), "|"),
    (re.compile(rf"(\\frac\s*\{{\s*d\s*{SIGN})\s*\([^()=]*\)(?=\s*\}}\s*\{{\s*d)"), r"\1"),  # dN(E) over dE
    # the standard state of chemists; behind a number, or an angle without an index, degrees
    (re.compile(r"_(\w|\{(?:[^{}]|\{[^{}]*\})*\})\s*\^\s*(?:\\circ|\{\s*\\circ\s*\})"), r"_{\1\\text{o}}"),
    (re.compile(r"(?<![A-Za-z\\])([A-Za-z])\s*\^\s*(?:\\circ|\{\s*\\circ\s*\})"), r"\1_{\\text{o}}"),
    (re.compile(r"\\(?:rm|mathrm)\s*\{"), r"\\text{"),
    (re.compile(r"_\s*\\(?:text|textrm)\s*(\{[^{}]*\})"), r"_{\\text\1}"),
    (re.compile(r"\s*\\prime(?![A-Za-z])(?<!\^\\prime)(?<!\{\\prime)"), "'"),
    (re.compile(r"\^(\d|\{\d\})\s*_(\w|\{[^{}]*\})"), r"_\2^\1"),
    (re.compile(rf"(?:\\(?:text|operatorname)\s*\{{\s*inv\s*\}}|\\inv(?![A-Za-z]))\s*({SIGN})"), r"(\\tan \1 - \1)"),
    (re.compile(r"\\(?:bar|overline)\s*\{\s*([A-Za-z])\s*\}\s*([a-z])(?![A-Za-z_])"), r"\\bar{\\text{\1\2}}"),
)


# characters in front of an equation that may say what it is; what its last sentence is in
_IN_FRONT, _SPOKEN = 240, 700
_FLAT = "it stands in plain text, where 12 may be 1/2 and x2 a square; give it between $$, as LaTeX"


@record
class _Spelling:
    """How a text writes its letters."""

    words: Sequence[str]  #: Letters of several characters
    indexed: frozenset[str]  #: Letters of which `Q_2^3` is one
    applied: re.Pattern[str] | None = None  #: Letters with arguments of which some are defined
    matrices: frozenset[str] = frozenset()  #: Letters that are turned over or given row by row
    delta: bool = False  #: Whether a delta stands alone, so that one before a letter is a factor
    diameter: bool = False  #: Whether a d is a letter of its own, so that one before a letter is a factor
    twofold: Sequence[str] = ()  #: Greek letters that its formulas have in both forms, which are two letters then
    rated: Sequence[str] = ()  #: Letters with a dot beside the same ones with the index d, which are two letters, too


@record
class Said:
    """An equation with its sides as trees; what cannot be read has none, and says why."""

    shown: Displayed
    name: str
    sides: tuple[Node, ...] = ()
    texts: tuple[str, ...] = ()
    claim: str = ""
    why: str = ""
    section: int = 0  #: Which section it stands in, counted [-]
    before: str = ""  #: Words in front of it
    about: str = ""  #: What they call what it gives
    law: LagrangeEquation | None = None
    inline: bool = False
    spelled: Mapping[str, str] = field(default_factory=dict)  #: Plain name to the author's LaTeX

    @property
    def equates(self) -> bool:
        """Whether it says within a sentence that two letters are one, of which nothing in front of it knows."""
        return self.inline and all(isinstance(side, ast.Name) for side in self.sides)


@record
class Text:
    """A text with its equations and its nomenclature."""

    said: Sequence[Said]
    named: Mapping[str, Named]  #: By plain name
    called: Mapping[str, str]  #: Words in front of a letter, by plain name
    prose: str


@dataclass
class _Spoken:
    """What the words in front of displays call what they give."""

    together: Counter[int]  #: Equations that stand in one display
    seen: Counter[int] = field(default_factory=Counter)

    def of(self, opens: int, before: str) -> tuple[str, str]:
        """The name of a letter that an equation gives, empty where none is told, and the last words in front of it."""
        many, place = self.together[opens], self.seen[opens]
        self.seen[opens] += 1
        phrase, about = subject(before, many == 1)
        if many == 1:
            return phrase, about
        names = listed(before, many) or [shared(before)] * many
        # of a row of many the first is what the words say, if they do not say it of all
        of_all = place == 0 or re.search(r"\b(?:are|both)\b", before[-120:])
        return names[place] or phrase, about if of_all else ""


def read_text_whole(text: str, marked: bool = False) -> Text:
    """All equations of a text in their order, those within its lines as well; marked: it marks every equation."""
    text = _BRACKETS.sub(lambda m: " $" if m[0] == r"\(" else "$ ", expanded(text))
    shown = displayed(text)
    formulas = " ".join(one.text for one in shown)
    spoken_of = with_marks(text, formulas)
    written = nomenclature(spoken_of)
    words = _words(written, shown)
    twofold = tuple(v for v in _TWOFOLD if all(re.search(rf"\\{c}{v}(?![A-Za-z])", formulas) for c in ("", "var")))
    dotted = sorted({*re.findall(r"\\dot\s*\{?\s*([A-Za-z])(?!\w|\s*\}?\s*_)", formulas)})
    rated = tuple(k for k in dotted if re.search(rf"(?<![A-Za-z\\]){k}_(?:d(?![A-Za-z])|\{{d\}})", formulas))
    plain = _Spelling(words=words, indexed=frozenset(), twofold=twofold, rated=rated)
    pairs: dict[str, set[tuple[str, str]]] = {}
    for match in _INDEXED.finditer(text):
        pairs.setdefault(match[1], set()).add((match[2].strip("{}"), match[3].strip("{}")))
    indexed = frozenset(
        base for base, both in pairs.items() if len(both) > 1 and all(abs(int(i) - int(j)) in (1, 3) for i, j in both)
    )
    named, ahead = _names(written, called(spoken_of), plain)
    starts = [m.start() for m in _SECTION.finditer(text)]
    lines = [0]
    lines += [m.end() for m in re.finditer("\n", text)]
    if not shown:
        bare = [] if marked else flattened(text)
        lost = [Said(shown=e, name=e.number or f"line {e.line}", why=_FLAT) for e in bare]
        return Text(said=lost, named=named, called=ahead, prose=text)
    spelling = replace(
        plain,
        indexed=indexed,
        applied=_applied(shown),
        matrices=matrices_of(shown),
        delta=bool(_ALONE_DELTA.search(text)),
        diameter="d" in ahead,
    )
    aside = [*_inline(text), *_tabled(written, lines)]
    everything = sorted([*((e, False) for e in shown), *((e, True) for e in aside)], key=lambda p: p[0].begins)
    rows = _rows(text, shown)
    spoken = _Spoken(together=Counter(rows[equation.opens] for equation in shown))
    said = []
    for equation, inline in everything:
        section = sum(start <= lines[equation.line - 1] for start in starts)
        opens = rows.get(equation.opens, equation.opens)
        words_end = opens or equation.begins  # of a row of many, the words in front of all
        before = text[max(0, words_end - _IN_FRONT) : words_end]
        one = _read(equation, spelling, section, before, inline)
        named_there = named_by_words(one.sides[0]) if one.sides and not inline else None
        if named_there is not None:
            left = named_there[0]
            phrase, last = spoken.of(opens, text[max(0, words_end - _SPOKEN) : words_end].partition(" ")[2])
            if not phrase and (after := _END.search(text, equation.begins + len(equation.text))):
                phrase = behind(text[after.end() : after.end() + 80])
                last = phrase or last
            one = replace(one, about=last)
            if phrase and isinstance(left, ast.Name):
                ahead.setdefault(left.id, phrase)
        if one.sides or not inline:
            said.append(one)
    return Text(said=said, named=named, called=ahead, prose=text)


def named_by_words(left: Node) -> tuple[Node, Callable[[Node], Node]] | None:
    """What the words in front of an equation may name, and what a right side makes of it.

    A letter, as of sin psi or 1/E, or the ratio of two; None where it is neither.
    """
    angle = argument_of(left, "sin", "cos", "tan")
    over = is_operation(left, ast.Div) and value_of(left.left) == 1
    named = angle if angle is not None else left.right if over and isinstance(left, ast.BinOp) else left
    of_two = is_operation(named, ast.Div) and all(isinstance(n, ast.Name) for n in (named.left, named.right))
    if not isinstance(named, ast.Name) and not of_two:
        return None
    if angle is not None:
        return named, partial(call, f"a{function_of(left)}")
    return named, partial(binary, ast.Div, number(1)) if over else lambda side: side


def _names(
    written: Mapping[str, Named], spoken: Mapping[str, str], spelling: _Spelling
) -> tuple[dict[str, Named], dict[str, str]]:
    # what tables and sentences say of letters, by plain name, and what each is called
    named: dict[str, Named] = {}
    for symbol, about in written.items():
        if plain := _plain(symbol, spelling):
            named.setdefault(plain, about)
    ahead = {plain: about.meaning for plain, about in named.items() if about.meaning}
    for symbol, phrase in spoken.items():
        if plain := _plain(symbol, spelling):
            ahead[plain] = phrase
    return named, ahead


def _rows(text: str, shown: Sequence[Displayed]) -> dict[int, int]:
    """Where the row of displays begins that a display belongs to, no word between them, by where it begins itself."""
    rows: dict[int, int] = {}
    last = 0
    for opens in dict.fromkeys(one.opens for one in shown):
        before = OPENED.sub("", text[max(0, opens - 60) : opens]).rstrip()
        rows[opens] = rows[last] if last and _CLOSED.search(before) else opens
        last = opens
    return rows


def _inline(text: str) -> Iterator[Displayed]:
    # a letter that a sentence defines: $\lambda = r/l$; data with a unit are none
    breaks = [m.start() for m in re.finditer("\n", text)]
    alone = {m.start(1) for m in _ALONE.finditer(text)}
    for match in islice(_INLINE.finditer(text), MOST):
        inside, data = match[1], re.search(r"=\s*-?\d[\d.,]*\s*(?:\\|\^|$)|\\text|\\mathrm", match[1])
        if not inside.count("=") or match.start() in alone or data:
            continue
        *firsts, last = (part.strip() for part in inside.split("="))
        if len(firsts) > 1 and not all(re.fullmatch(SIGN, part) for part in (*firsts, last)):
            continue  # but for m_1 = m_2 = m
        for first in firsts:
            line = bisect_right(breaks, match.start()) + 1
            yield Displayed(number="", label="", text=f"{first} = {last}", line=line, begins=match.start())


def _tabled(written: Mapping[str, Named], lines: Sequence[int]) -> Iterator[Displayed]:
    # a letter that the nomenclature defines: rod ratio $r/l$
    for symbol, about in written.items():
        if ratio := _RATIO.search(about.meaning):
            whole = f"{symbol} = {ratio[1]}"
            yield Displayed(number="", label="", text=whole, line=about.line, begins=lines[about.line - 1])


def _words(written: Mapping[str, Named], shown: Sequence[Displayed]) -> list[str]:
    # letters of several characters: those of the nomenclature, and left sides that are one word
    words = {s.split("_")[0] for s in written if re.fullmatch(r"[A-Za-z]{2,5}(?:_.*)?", s)}
    singles = {s.split("_")[0] for s in written if re.fullmatch(r"[A-Za-z](?:_.*)?", s)}
    for equation in shown:
        left = equation.text.partition("=")[0].strip()
        if re.fullmatch(r"[A-Za-z]{2,5}", left) and not set(left) <= singles and left[0] != "d":
            words.add(left)
    return sorted(words - NO_LETTERS, key=len, reverse=True)


def _plain(symbol: str, spelling: _Spelling) -> str:
    try:
        tree = read_latex(_prepared(symbol.partition("=")[0].strip(), spelling), whole=True)[0]
    except BadInput:
        return ""
    return tree.id if isinstance(tree, ast.Name) else ""


def _prepared(text: str, spelling: _Spelling) -> str:
    if spelling.applied is not None:
        text = spelling.applied.sub(_letter_alone, text)
    text = calligraphic(text) if not _NO_PRODUCT.search(text) else text
    text = "".join(rf"\{_COMMANDS[c]} " if c in _COMMANDS else c for c in text)
    for pattern, instead in _TIDY:
        text = pattern.sub(instead, text)
    for letter in spelling.twofold:
        text = re.sub(rf"\\var{letter}(?![A-Za-z])", rf"\\Var{letter} ", text)
    for letter in spelling.rated:
        text = re.sub(rf"(?<![A-Za-z\\]){letter}_(?:d(?![A-Za-z])|\{{d\}})", rf"{letter}_{{\\text{{{_INDEX}}}}}", text)
    if spelling.delta:
        text = re.sub(r"\\delta(?=\s*(?:\\[,;:! ]\s*)?\\?[A-Za-z])", r"{\\delta}", text)
    if spelling.diameter and "int" not in text:  # pi d b is no differential, which stands above another one
        text = re.sub(r"(?<=[A-Za-z0-9}] )d(?= +[A-Za-z](?![A-Za-z]))", "{d}", text)
        text = re.sub(r"(\\frac\{(?!\s*d)[^{}]*\}\s*\{\s*)d(?= +[A-Za-z](?![A-Za-z]))", r"\1{d}", text)
    text += "}" * (text.count("{") - text.count("}") == 1)  # one brace lost at the end
    text = _INDEXED.sub(
        lambda m: f"{m[1]}_{{{m[2].strip('{}')}{m[3].strip('{}')}}}" if m[1] in spelling.indexed else m[0], text
    )
    for word in spelling.words:
        inside = r"\s*".join(word)
        text = re.sub(rf"(?<![A-Za-z\\])(?<!_\{{)(?<!text\{{){inside}(?![A-Za-z])", rf"\\text{{{word}}}", text)
    return unapplied(text, _APPLIED)


def _letter_alone(match: re.Match[str]) -> str:
    letter = match["own"] or match["of"]
    return match[0] if letter.lstrip("\\") in NO_LETTERS else letter


_TWOFOLD = ("theta", "phi", "rho", "epsilon")
_INDEX = "dx"  # d as an index
_VARIANT = re.compile(r"\\V(ar[a-z]+)")
_ALONE_DELTA = re.compile(r"\\delta\s*[=$,)}^]")
_COMMANDS = {sign: "lambda" if name == "lam" else name for name, sign in SYMBOLS.items()} | {"ϕ": "varphi"}


def _applied(shown: Sequence[Displayed]) -> re.Pattern[str] | None:
    r"""A letter with arguments that some equation defines a letter with: t(R) beside t_p(R) = .. is no product.

    Nor is D(x)^2 beside D(x) = ..; of another letter it may be.
    """
    own, arguments = set(), set()
    for one in shown:
        left = re.sub(r"\\(?:left|right)\b|\\[,;:! ]", " ", one.text.partition("=")[0])
        match = _DEFINED.fullmatch(" ".join(left.split()))
        if match is not None and match[1].lstrip("\\") not in NO_LETTERS:
            own.add(match[1])
            arguments |= {part.strip() for part in match[2].split(",")}
    if not arguments:
        return None
    any_of = _any_of(arguments)
    within = rf"\s*(?:{any_of})(?:\s*,\s*(?:{any_of}))*\s*"
    letter = rf"(?:(?<![A-Za-z\\])(?P<own>{_any_of(own)})|(?P<of>{SIGN}))"
    return re.compile(rf"{letter}\s*(?:\\left)?\({within}(?:\\right)?\)(?(own)|(?!\s*\^))")


def _any_of(signs: set[str]) -> str:
    # longer ones first, and in one order in every run
    return "|".join(re.escape(sign) for sign in sorted(signs, key=lambda sign: (-len(sign), sign)))


def _read(shown: Displayed, spelling: _Spelling, section: int, before: str, inline: bool) -> Said:
    name = shown.number or shown.label or f"line {shown.line}"
    head = Said(shown=shown, name=name, section=section, before=before, inline=inline)
    try:
        if reason := refused(shown.text, before, spelling.matrices):
            raise BadInput(reason)
        if (law := lagrange_equation(shown.text)) is not None:
            sign = f"integral{crc32(shown.text.encode()):08x}"  # one symbol, of which the energies tell
            return replace(head, law=law, sides=(name_of(sign), number(0)), texts=(shown.text, "0"))
        whole = _sides(head, _prepared(shown.text, spelling))
        own = {k: _VARIANT.sub(r"\\v\1", v).replace(rf"\text{{{_INDEX}}}", "d") for k, v in whole.spelled.items()}
        return replace(whole, spelled=own)
    except BadInput as error:
        return replace(head, why=str(error))
    except RecursionError:
        return replace(head, why="it is nested too deep to be read")


def _sides(head: Said, text: str) -> Said:
    if operator := _NO_PRODUCT.search(text):
        raise BadInput(f"{operator[0].strip()} is no number: complex numbers and operators on braces are not read")
    zero = re.search(r"=\s*0\s*$", text)
    if not zero and _NO_EQUATION.search(text.partition("=")[2] or text) and r"\begin" not in text:
        raise BadInput("it is a range, a limit or an inequality, no equation")
    if zero and text.count("=") == 1:
        parts: tuple[str, ...] = (text[: zero.start()], "0")
        claim = ""
    else:
        said = statement(text)
        if not said.left:
            raise BadInput("there is no equals sign")
        parts, claim = (said.left, *said.right), said.claim
    spelled: dict[str, str] = {}
    trees = []
    for part in parts:
        tree, how = read_latex(part, whole=True)
        check(tree)
        spelled |= how
        trees.append(tree)
    return replace(head, sides=tuple(trees), texts=parts, claim=claim, spelled=spelled)
