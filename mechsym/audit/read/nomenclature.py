r"""What a text calls its letters: tables, lists, and the words in front of them and behind."""

import re
from collections.abc import Iterator, Sequence

from mechsym.audit.read.called import spoken
from mechsym.audit.read.phrases import PLURALS
from mechsym.audit.read.spelling import SYMBOLS
from mechsym.audit.read.units import KINDS, OTHERS, unit_of
from mechsym.quantities import record


@record
class Named:
    """A letter of a nomenclature."""

    meaning: str
    unit: str  #: As `dimension` reads it, empty where none is printed
    line: int  #: Of the file [-]


_SYMBOL = r"(\$[^$\n]{1,40}\$|\\\([^\n]{1,40}?\\\)|[A-Za-zα-ωΑ-Ω][\w{}\\^]{0,12})"
_LISTED = re.compile(
    rf"{_SYMBOL}\s*(?:[–—=:]|-{{1,3}}|is the|denotes the)\s*([A-Za-z][^\[\]\n;,$&|]{{2,70}}?)"
    r"(?<![(.])\s*\[([^\[\]\n]{1,40})\]"  # no call in a program
)
_BACKWARDS = re.compile(
    r"^\s*[-*+]\s*([A-Za-z][^:`$\[\]\n]{2,60}):\s*[`$]([^`$\n]{1,24})[`$]\s*(?:\([^()]*\)\s*)?\[([^\[\]\n]{1,40})\]"
)
_BOLD = re.compile(
    r"^\s*[-*+]\s*(?:\*\*|`)([^*`$\n]{1,24}?)(?:\*\*|`)\s*[=:–—-]\s*"
    r"([A-Za-z][^()\[\]\n]{2,60}?)\s*(?:[(\[]([^()\[\]\n]{1,24})[)\]])?\s*$"
)
_ITEM = re.compile(  # of a list of descriptions, or of points
    r"^\s*(?:\\item\s*\[([^\[\]\n]{1,24})\]|(?:\\item|[-*+])\s*((?:\$[^$\n]{1,24}\$\s*,\s*)*\$[^$\n]{1,24}\$)\s*[:=,–—-])"
    r"\s*([A-Za-z][^()\[\]\n]{2,60}?)\s*(?:[(\[]([^()\[\]\n]{1,24})[)\]]|,\s*([^,()\[\]\n]{1,24}))?\s*[.,;]?\s*$"
)
_PURE = re.compile(r"\b(?:coefficients?|factors?|numbers?|ratios?|efficienc(?:y|ies)|exponents?)$")
# crank radius $r$ (m), crank angle $\varphi$ of the first crank (rad)
_UNIT_BEHIND = re.compile(
    r"\b([a-z][a-z\s-]{2,60}?)\s+\$([^$\n=]{1,40})\$(?:\s+of\s+(?:the\s+)?[a-z ]{3,40})?\s*\(([^()\n]{1,20})\)"
)
# $D$ bore (m), $S$ stroke (m): one behind the other in a sentence
_RUN_IN = re.compile(
    r"[$`]([^$`\n]{1,40})[$`]\s+([a-z][A-Za-z\s-]{2,60}?)(?:\s*[(\[]([^()\[\]\n]{1,20})[)\]](?=\s*(?:[,.;]|$))|(?=\s*[,.;]))",
    re.MULTILINE,
)
# $D$ -- bore, m; $S$ -- stroke, m
_IN_SENTENCE = re.compile(
    r"\$([^$\n=]{1,40})\$\s*(?:-{1,3}|[–—:=])\s*([A-Za-z][^;$]{2,80}?),\s*((?:[^;,]|\\,){1,30}?)\s*(?=[;.]\s)"
)
_FEWEST, _LONGEST = 4, 6000  # letters of such a list; characters of a row
_PROSE = re.compile(r"\b([a-z]+)\s*\(\s*(\$?[^()$\n*/]{1,24}\$?)\s*\)")
_WHERE = re.compile(
    r"\$([^$\n]{1,40})\$,?\s*(?:(is|are|be|denotes|represents|being|as|=)\s+)?(?:the|an?)\s+([A-Za-z][A-Za-z\s-]{2,60}?)"
    # the force $F$, the mass $m$: what stands before a letter is not said of the one before it
    r"(?=[ \t]*\n[ \t]*\n|\s*(?:[,;.)(:]|\band\b|\bin\b|(?(2)\$|(?!))|\Z"
    r"|\bof\b(?!\s+(?:inertia|elasticity|specific|turns|revolutions|teeth|cylinders|(?:the\s+)?fuel))))"
)
_KINDS = "|".join(kind.replace(" ", r"\s+") for kind in sorted(KINDS, key=len, reverse=True))
_AHEAD = re.compile(
    rf"\b(\w{{1,20}})\s+({_KINDS})\s+"
    r"\$([^$\n=]{1,40})(?:=[^$\n]*)?\$(?!\s+per\b)"
)
# the crank radius $r$ in m, of stiffness $k$ in N/m
_IN_TURNS = re.compile(r"\s+in\s+(?:revolutions|turns)\s+(?:per|a)\s+minute\b")
_SYMBOLS = (
    r"(?:k?g|[cmk]?m|m?s|min|h|K|[kM]?N|[kMG]?Pa|bar|[kM]?J|[kM]?W|rad|Hz)(?:\$?\^\{?-?\d\}?\$?|[²³⁴])?(?![A-Za-z\d$])"
)
_IN_UNIT = re.compile(rf"\$([^$\n=]{{1,40}})\$\s+in\s+({_SYMBOLS}(?:(?:\s|\\,|·|/|\*)+{_SYMBOLS})*)(?=[\s.,;:)]|\Z)")
_BETWEEN = re.compile(r"\$\\?(?:overline)?\{?\s*[A-Z]{2}\s*\}?\s*=\s*(\\?[A-Za-z]+(?:_\w)?)\s*\$")  # the crank $OA = r$
_UNMARKED = re.compile(  # what stands in a formula is let be
    rf"\$\$[^$]*\$\$|\$[^$]*\$|\b({_KINDS}|stiffness|rate|travel|mass|angle|speed)\s+([A-Za-z])"
    r"(?=[,.;:)]|\s+(?:and|of|is|joins|turns)\b|\s*\n\s*\n)"
)
_LETTER = r"\$[^$\n=]{1,40}\$"
_NEXT = r"(?:,\s*(?:and\s+)?|\s+and\s+)"
# the angles $a$, $b$ of crank and rocker; the lengths are $a$ (crank), $b$ (rod)
_EACH_AS = re.compile(
    rf"\b([a-z]+)\s+(?:are\s+)?((?:{_LETTER}\s*\([a-z][a-z -]*\)(?:{_NEXT}|(?=\s*[.;:]|\s[a-z]))){{2,}})"
)
_BEGINS = re.compile(r"(?<!\bof )(?<!\babout )\b(?:the|an?|its|their|whose|and|with|by|has|is)\s+", re.IGNORECASE)
# what goes on to a display, as `the volume of both is`
_AHEAD_OF = re.compile(
    r"(?:\s+(?:of|in|for|with|at|on|between)\b[^.;:$]{0,60}?)?(?:\s+(?:is|are|becomes))?\s*(?:\$\$|\\\[|\\begin)"
)
_OVER = re.compile(r"\$\s*\\?[A-Za-z]+\s*/\s*\\?[A-Za-z]+\s*\$")  # the ratio of two letters
_FORMULA = re.compile(r"=|\\(?:approx|simeq|frac|sqrt|left|sin|cos|tan)\b")
_SPACED_ROW, _SPACED = re.compile(r"\s*\$[^$|&\t]+\$\s{2,}[A-Za-z][^|&\t$]*$"), re.compile(r"\s{2,}")  # of Sphinx
_CELLS = re.compile(r"(?<!\\)&|\||\t")


def nomenclature(text: str) -> dict[str, Named]:
    """Letters as they are spelled there, with what they are called and measured in."""
    names: dict[str, Named] = {}
    units = [m for m in _UNIT_BEHIND.finditer(text) if unit_of(m[3])]
    for match in units if len(units) >= _FEWEST else ():
        line, phrase = text.count("\n", 0, match.start()) + 1, " ".join(_BEGINS.split(match[1])[-1].split())
        names.setdefault(spelled(match[2]), Named(meaning=phrase, unit=unit_of(match[3]) or "", line=line))
    listed_in = [m for m in _IN_SENTENCE.finditer(text) if unit_of(m[3])]
    for match in listed_in if len(listed_in) >= _FEWEST else ():
        line, phrase = text.count("\n", 0, match.start()) + 1, " ".join(match[2].split())
        names.setdefault(spelled(match[1]), Named(meaning=phrase, unit=unit_of(match[3]) or "", line=line))
    run = [m for m in _RUN_IN.finditer(text) if not m[3] or unit_of(m[3])]
    run = run if sum(bool(m[3]) for m in run) >= _FEWEST else _in_a_row(run, text)
    for match in run:
        line = text.count("\n", 0, match.start()) + 1
        unit = (unit_of(match[3]) if match[3] else "") or ""
        names.setdefault(spelled(match[1]), Named(meaning=" ".join(match[2].split()), unit=unit, line=line))
    rows = text.split("\n")
    measured = sum(bool(_item(m, False)[2]) for row in rows for m in _ITEM.finditer(row[:_LONGEST])) >= _FEWEST
    for number, row in enumerate(rows, 1):
        if len(row) > _LONGEST:
            continue
        listed = [*_cells(row), *((m[1], m[2], m[3]) for m in _LISTED.finditer(row))]
        listed += [(m[2], m[1], m[3]) for m in _BACKWARDS.finditer(row)]
        listed += [_item(m, measured) for m in _ITEM.finditer(row)]
        listed += [(m[1], m[2], m[3] if m[3] and unit_of(m[3]) else "") for m in _BOLD.finditer(row)]
        for symbol, meaning, unit in listed:
            known = unit_of(unit) if unit else None
            symbols = re.split(r",\s*(?![^{]*\})", symbol.strip("$ "))
            for one, its in zip(symbols, _each(meaning.strip(), len(symbols)), strict=True):
                one = spelled(one.partition("=")[0])
                if one and one not in names and (known or not unit.strip()):
                    names[one] = Named(meaning=its, unit=known or "", line=number)
        for match in _PROSE.finditer(row) if not listed else ():  # what stands in brackets there is a unit
            one = spelled(match[2])
            in_unit = match[1] != "module" and unit_of(match[2]) == KINDS.get(match[1])  # radius (m)
            if not run and match[1] in KINDS and one and len(one) < 20 and one not in names and not in_unit:
                names[one] = Named(meaning=match[1], unit="", line=number)
    where = [m for m in _WHERE.finditer(text) if not _is_called_before(text, m)]
    counted = [_IN_TURNS.match(text, m.end()) for m in where]
    phrases = [(m[1], m[3] + (c[0] if c else ""), m.start()) for m, c in zip(where, counted, strict=True)]
    phrases += [
        (m[3], whole if (whole := f"{m[1]} {m[2]}") in KINDS else m[2], m.start())
        for m in _AHEAD.finditer(text)
        if not OTHERS.fullmatch(m[1]) and m[1] != "over" and not _is_moment(text, m)
    ]
    for symbol, meaning, start in phrases:
        one = spelled(symbol.partition("=")[0])
        if one and one not in names:
            names[one] = Named(meaning=" ".join(meaning.split()), unit="", line=text.count("\n", 0, start) + 1)
    for match in _IN_UNIT.finditer(text):
        one, known = spelled(match[1]), unit_of(match[2])
        if one and known and not (one in names and names[one].unit):
            line, meaning = text.count("\n", 0, match.start()) + 1, names[one].meaning if one in names else ""
            names[one] = Named(meaning=meaning, unit=known, line=line)
    return names


def with_marks(text: str, formulas: str) -> str:
    """A text in which letters of its formulas have dollars where a sentence calls them by name alone: the radius a."""
    text = _BETWEEN.sub(r"$\1$", text)
    used = {*re.findall(r"(?<![A-Za-z\\])[A-Za-z](?![A-Za-z])", formulas)}
    return _UNMARKED.sub(lambda m: f"{m[1]} ${m[2]}$" if m[1] and m[2] in used else m[0], text)


def _each(meaning: str, count: int) -> list[str]:
    # indicated and effective power; moments of inertia of the engine and of the propeller
    if count == 2 and (
        of_both := re.fullmatch(r"([a-z]+) and ([a-z]+) ((?!of (?:inertia|area))[a-z ]+)", meaning, re.I)
    ):
        return [f"{of_both[1]} {of_both[3]}", f"{of_both[2]} {of_both[3]}"]
    if count == 2 and (both := re.fullmatch(r"(.+) (of .+?) and (of .+)", meaning)):
        head = " ".join(PLURALS.get(word, word) for word in both[1].split())
        return [f"{head} {both[2]}", f"{head} {both[3]}"]
    apart = meaning.split(" and ")  # crank radius and rod length
    return apart if count == len(apart) == 2 else [meaning] * count


def _item(match: re.Match[str], measured: bool) -> tuple[str, str, str]:
    # letters, meaning and unit of a point; measured: whether the others have units, so that a ratio without is a number
    unit = next((u for u in (match[4], match[5]) if u and unit_of(u)), "")
    meaning = match[3] if unit or not match[5] else f"{match[3]}, {match[5]}"
    pure = "-" if measured and _PURE.search(meaning) else ""
    return (match[1] or match[2]).replace("$", ""), meaning, unit or pure


def _in_a_row(run: Sequence[re.Match[str]], text: str) -> list[re.Match[str]]:
    # $r$ radius of the crank, $l$ length of the rod, .. one behind the other
    rows: list[list[re.Match[str]]] = [[]]
    for match in (m for m in run if not _BEGINS.match(m[2])):  # what has an article is read where it is said
        behind = rows[-1] and re.fullmatch(r"\s*[,;]\s*", text[rows[-1][-1].end() : match.start()])
        rows[-1].append(match) if behind else rows.append([match])
    return [match for row in rows if len(row) >= _FEWEST for match in row]


def _is_moment(text: str, match: re.Match[str]) -> bool:
    # the second moment of area $I$
    before = text[max(0, match.start() - 20) : match.start()]
    return match[1] == "of" and bool(re.search(r"\b(?:moments?|rate|flow|flux|loss|cent(?:er|re)s?)\s+$", before))


def _is_called_before(text: str, match: re.Match[str]) -> bool:
    # the load $F$ the stress: what follows without a comma or a verb is said of something else
    comma = text[match.end(1) + 1 : match.end(1) + 2] == ","
    if not comma and not match[2] and "=" in match[1]:
        return True  # with $\lambda = r/l$ the way is
    before = re.search(r"([A-Za-z-]+)\s*$", text[max(0, match.start() - 40) : match.start()])
    if comma and not match[2] and _AHEAD_OF.match(text, match.end()):
        return True  # it is said of the equation behind
    if comma and not match[2] and before is not None and before[1] in ("is", "are"):
        return True  # the work is $W$, the volume
    if comma and not match[2] and "=" in match[0] and before is not None and before[1] in (*KINDS, "speed"):
        return True  # at a constant speed $\omega = \dot\theta$, the velocity
    apart = match[2] or comma
    return not apart and before is not None and before[1].lower() not in ("where", "with", "and", "let", "here")


def called(text: str) -> dict[str, str]:
    """Letters as they are spelled there, with what sentences call them: the rod force $S$."""
    names: dict[str, str] = {}
    for symbol, phrase in (*_shared(text), *spoken(text)):
        names.setdefault(spelled(symbol), phrase)
    return names


def _shared(text: str) -> Iterator[tuple[str, str]]:
    # letters with one head, and what each is of
    for match in _EACH_AS.finditer(text):
        if match[1] in PLURALS:
            pairs = re.findall(r"\$([^$]+)\$\s*\(([^()]+)\)", match[2])
            yield from ((symbol, f"{owner} {PLURALS[match[1]]}") for symbol, owner in pairs)


def _cells(row: str) -> Iterator[tuple[str, str, str]]:
    # symbol, meaning and unit of a row of a table; what has no unit in its last cell may still name a letter
    columns = _SPACED if _SPACED_ROW.match(row) else _CELLS
    cells = [c.strip() for c in columns.split(row.replace(r"\\", "").replace(r"\hline", "").strip())]
    cells = cells[1:-1] if row.strip().startswith("|") else cells
    for start in range(0, len(cells) - 1, 3):
        group = cells[start : start + 3]
        symbol = group[0]
        if len(group) == 3 and unit_of(group[1]) and re.search(r"[A-Za-z]{3}", group[2]):  # symbol, unit, meaning
            group = [symbol, group[2], group[1]]
        elif (
            re.fullmatch(r"\$[^$]+\$", group[1] if len(group) > 1 else "") and "$" not in symbol
        ):  # meaning, symbol, unit
            symbol, group = group[1], [group[1], symbol, *group[2:]]
        meaning = group[1] if len(group) > 1 else ""
        wordy = re.search(r"[A-Za-z]{3}", meaning) and not _FORMULA.search(meaning) or _OVER.fullmatch(meaning)
        if (
            symbol
            and len(symbol) <= 60
            and wordy
            and not re.search(r"[A-Za-z]{3,} [A-Za-z]", re.sub(r"\\[A-Za-z]+", "", symbol))
        ):
            yield symbol, group[1], group[2] if len(group) > 2 else ""


def spelled(symbol: str) -> str:
    """A letter of prose as LaTeX: `σ _{FP}` is `\\sigma_{FP}`."""
    symbol = re.sub(r"</?sub>|<[^<>]*>", "", symbol.strip(" $*").replace("<sub>", "_"))
    symbol = re.sub(r"\s*([_^{}])\s*", r"\1", symbol)
    back = {sign: rf"\{'lambda' if name == 'lam' else name} " for name, sign in SYMBOLS.items()}
    symbol = "".join(back.get(c, c) for c in symbol).strip()
    return re.sub(r"\\(?:mathrm|text|textrm|rm|mathbf)\b\s*", "", symbol)
