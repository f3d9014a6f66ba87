"""What the words in front of an equation call what it gives: `The stress of a bar is`, `the rod carries`."""

import re

from mechsym.audit.read.nomenclature import ENDS, PLURALS
from mechsym.audit.read.units import KINDS

_REFERS = re.compile(r"\s+(?:refers|relates) to\s.*$")  # the mean pressure refers to the projected area
_PUT_IN = re.compile(
    r"(\s(?:is|are|becomes|reads))\s*,\s+(?:to|in|for|with|at|by|as|up)\s[^,]*$"
)  # the travel is, to the second order,
_SHORT = r"(?:[A-Za-z-]+\s+){0,3}?[A-Za-z-]{3,}"
_PLAIN = r"(?:(?!(?:the|an?|its)\s)[A-Za-z-]+\s+){0,2}[A-Za-z-]{3,}"
_INSIDE = re.compile(rf"\s+(?:in|along|between|about)\s+(?:the|an?|its|both)\s+{_PLAIN}")
# the efficiency, with the heating value $H$ of the fuel
_WITH_LAST = re.compile(r"(?<=[a-z])\s*,\s+with\s+the\s+[a-z ]+$")
_WITH_LETTER = re.compile(r",\s+with\s[^,]*\$[^,]*$")
_OPENING = (
    "The|With|Without|For|At|In|From|By|On|Of|If|When|Let|As|Under|Over|Both|Each|Also|Here|Then|Hence|Thus|Half|Part"
    "|Some|All|Most|One|Two|Three|Any|Every|Such|What|Which|There|It|This|That|These|Those|We|Here|Where|While|So|But"
)
_BARE = rf"(?!(?:{_OPENING})\b)[A-Z][a-z]"  # a sentence that begins with the name: Brake power of
_OUT_OF = re.compile(r"\s+(?:follows|results)\s+(?:from|with|by)\s+(?:the|its)\s[^,]*$")
_FOR = re.compile(r"^(?:For|With|In|At|From|By)\b.*\bthe\s+")  # for the unevenness the speeds
# the torque is with the volume $V$ of both: a letter stands behind the last of what it is with
_GIVEN_WITH = re.compile(r"\s(?:is|are|becomes)\s+(?:with|for|at)\s+[^,]*\$[^$]+\$(?:\s+of\s+[a-z ]+)?\s*$")
# the gas presses with a force
_ACTS = re.compile(
    rf"\b(?:the|its|an?)\s+({_SHORT}?)(?:\s+pressure)?(?:\s+(?:of|at|on|in|above)\b[^.]*?)?"
    r"\s+(?:presses|pushes|pulls|acts|resists)(?:\s+[a-z]+){0,3}?\s+with$",
    re.IGNORECASE,
)
# verbs between the name of what an equation gives and the equation
_CLOSING = re.compile(
    r"\s+(?:(?:may|can|must|is|are) (?:then |also |now )?(?:be )?"
    r"(?:taken|written|given|expressed|obtained|found|approximated|computed|calculated)(?: as| by| to be| from)?"
    r"|(?:is|are|becomes) (?:therefore|then|thus|hence|simply|now|accordingly)"
    r"|(?:cannot|can not|can never) (?:exceed|be (?:better|more|higher|greater|larger) than)|can at best be"
    r"|is|are|be|becomes|reads|remains|equals|follows(?: as| from)?|amounts to|comes to|results(?: as)?|reduces to)$"
)
# the guide is loaded by, the pin carries
_LOADED = re.compile(
    rf"\b(?:the|its)\s+({_SHORT})\s+(?:(?:is|are)\s+(?:loaded|pressed)\s+(?:by|with)|carries|bears|transmits)$",
    re.IGNORECASE,
)
_STRAINED = re.compile(r"\b(bent|twisted)\s+(?:by|with)\s+the\s+(?:shear\s+)?stress$")
_STORES = re.compile(r"\bstores$")
_PRESSED = re.compile(r"\bpresses\s+(?:on|against)\s+(?:the|its)\s+(?:guide|liner|cylinder wall)\s+with$")
_IN_HERTZ = re.compile(r"^In (?:hertz|Hz)\s+(?:it|this)$", re.IGNORECASE)
_AT_PIN = re.compile(
    r"^(?:and\s+)?(?:(?:that|the (?:mass|one))\s+)?at\s+(the\s+[a-z]+\s+(?:pin|end))(?:\s+is)?$", re.IGNORECASE
)
_TWO_MASSES = re.compile(r"\bpoint masses\b|\btwo masses\b")
_SWINGS = re.compile(r"\b(?:swings?|vibrates?|oscillates?)\b[^.;]*\bwith$")
_BORNE = re.compile(r"^and\s+the\s+([a-z]+(?:\s[a-z]+)?)\s+the\s+force$")  # the guide carries .., and the rod the force
# the energy of the flywheel at the mean speed
_AT_LAST = re.compile(r"(\bof\s+(?:the|an?|its)\s+[a-z-]+)\s+(?:at|with|for|under)\s+(?:the|an?)\s+[a-z -]+$")
_FROM_IT = re.compile(r"^From (?:it|this|that|them|these) (?:follows?|comes?)\b")
_MOVES = re.compile(r"\s(?:runs|lies|moves|turns|rotates|swings|acts|works|flows|stands)$")  # the engine runs with
_BESIDE = re.compile(r"\s(?:with|at|for|in|by|from|to|between|under)\s")  # what a quantity is of ends there
_AT_DEAD_CENTRE = re.compile(r"\bat (?:the )?(top|bottom) dead cent(?:re|er)\b", re.IGNORECASE)
_LEFT = re.compile(r"\bwhat (?:is left|remains) of\b|\bthe (?:rest|remainder) of\b", re.IGNORECASE)
_THAT_OF = re.compile(r"^(?:and\s+|The\s+)?that of ([a-z]+(?: [a-z]+){0,2}?)(?:\s+is)?$", re.IGNORECASE)
_HEAD_OF = re.compile(r"\b(?:the|its)\s+((?:[a-z-]+\s+)?[a-z-]+) of\b", re.IGNORECASE)
_LAST, _NEAR = 6, 400  # words in front of an equation; characters that a sentence before it may refer to
# names with an `of` of their own
_FUSED = re.compile(
    r"\b(moments?|modulus|coefficient|radius|degree|speed|velocity) of "
    r"(inertia|elasticity|friction|gyration|irregularity|non-uniformity|unevenness|fluctuation|sound|rotation)\b"
)
_VERB = re.compile(
    r"\b(?:is|are|was|were|can|may|must|will|has|have|gives?|follows?|yields?|stores?|carries|carry|turns(?!\s+(?:per|a)\b)|makes?|becomes?|means|reads?|that|which)\b"
)
# a shaft of the diameter $d$ has: the diameter is said of its own letter
_LETTER_LAST = re.compile(r"\b(?:the|an?|its|of)\s+(?:[a-z-]+\s+){1,4}\$[^$]+\$\s*(?:is|are|has|be|becomes)?\s*$", re.I)
# what the letter is called
_OF_LETTER = re.compile(r"\s+(?:the|an?|its|of)\s+(?:(?!the\b|an?\b|its\b)[a-z-]+\s*){1,4}$")
_PER = re.compile(r"\bper\s+(?:unit|metre|meter|kilogram|mass|volume|area|length|mole|cycle|degree)\b")
#: Where a display begins, at the end of what stands in front of it
OPENED = re.compile(r"(?:\\begin\{[a-z*]+\}|\$\$|\\\[|```math)\s*$")
# what is no word of a sentence; where it began itself
_UNWORDED = re.compile(r"\$[^$]*\$|\\[A-Za-z]+\*?(?:\[[^\]]*\])?(?:\{[^{}]*\})?|\\.|[{}~]")
_SENTENCE = re.compile(r"\\end\{[a-z*]+\}|\$\$|\\\]|[.:;!?](?=\s)|\n\s*\n")
_RATIO_OF_TWO = re.compile(r"\bratio (?:of|between) .* (?:and|to)\b")


def subject(before: str, alone: bool) -> tuple[str, str]:
    """What the sentence in front of an equation says that it gives, and of what, or its last words.

    before: the text up to the equation. alone: whether it gives one thing.
    """
    words, spoken, sentence = _sentence(before)
    sentence = re.sub(r"\s*\([^()]*\)$", "", sentence)
    sentence = re.sub(r"(?:^|\s*,\s+)that is\s*,\s+", " ", sentence)
    sentence = _PUT_IN.sub(r"\1", _REFERS.sub(" is", sentence))
    if _LEFT.search(sentence):
        return "", ""  # of a quantity another one is left
    if (place := _AT_PIN.search(sentence)) and _TWO_MASSES.search(words[-_NEAR:]):
        return f"mass at {place[1].lower()}", f"mass at {place[1].lower()}"  # the rod is replaced by two masses
    if (that := _THAT_OF.search(sentence)) and (heads := _HEAD_OF.findall(words[: -len(spoken)])):
        return "", f"{heads[-1]} of {that[1]}"  # the force of first order .., and that of second order
    sentence = _OUT_OF.sub(" is", sentence)
    if _WITH_LETTER.search(spoken):
        sentence = _WITH_LAST.sub("", sentence)
    bare = _CLOSING.sub("", sentence)
    shorter = re.sub(r"\s*,\s+(?:at|with|without|for|in|by)\s+[^,]*$", "", bare)
    if bare != sentence or _CLOSING.search(shorter):  # the radial force, at a pressure angle, is
        bare = _CLOSING.sub("", shorter)
    if _GIVEN_WITH.search(spoken):
        bare = re.sub(r"\s+(?:is|are|becomes)\s+(?:with|for|at)\s+[^,]*$", "", bare)
    # the work is .., and the mean pressure; from it follow, at an even speed, the piston speed
    clause = re.split(r"\s,\s+(?=the\s)" if _FROM_IT.match(bare) else r",\s+and\s+(?=(?:the|its)\s)", bare)[-1]
    if clause != bare and not _VERB.search(clause):
        bare = clause
    bare = _AT_LAST.sub(r"\1", _FUSED.sub(r"\1-of-\2", bare))
    bare = _OF_LETTER.sub("", bare) if _LETTER_LAST.search(spoken) and bare == sentence else bare
    tail = _FOR.sub("", " ".join(bare.split()[-_LAST:]).replace("-of-", " of "))
    if not alone:
        return "", tail
    if by_verb := _by_verb(bare):
        return by_verb, tail
    chosen, of_what = _chosen(bare, spoken, ends=bare != sentence)
    if not chosen or _PER.search(bare) or chosen == "ratio" or _RATIO_OF_TWO.search(bare):
        return "", tail
    phrase = ENDS.sub("", chosen).replace("-of-", " of ")
    if place := _AT_DEAD_CENTRE.search(bare):
        return f"{phrase} at {place[1].lower()} dead centre", tail
    if phrase.endswith(" one"):  # the tangential force, and the radial one
        words = re.sub(r"\bwith the [a-z -]+", "", words)
        before_it = [PLURALS.get(w, w) for w in re.findall(r"[a-z]+", words.lower().rpartition(" one")[0])]
        kinds = [word for word in before_it if word in (*KINDS, "speed")]
        phrase = f"{phrase[:-4]} {kinds[-1]}" if kinds else ""
    whole = of_what.replace("-of-", " of ")
    return phrase, whole if whole.startswith(phrase) else phrase or tail


def _by_verb(bare: str) -> str:
    """What a verb says without a name: what carries bears a force, what swings has a frequency."""
    if strained := _STRAINED.search(bare):
        return {"bent": "bending stress", "twisted": "torsional stress"}[strained[1]]
    if _STORES.search(bare):
        return "stored energy"
    if _PRESSED.search(bare):
        return "side force"
    if _IN_HERTZ.search(bare):
        return "natural frequency in hertz"
    if _SWINGS.search(bare):
        return "natural frequency"
    if borne := _BORNE.search(bare):
        return f"force on the {borne[1]}"
    if (loaded := _LOADED.search(bare)) and " and " not in loaded[1]:
        return f"force on the {loaded[1]}"
    acts = _ACTS.search(bare)
    return f"{' '.join(acts[1].split()[-2:])} force" if acts else ""


def _chosen(bare: str, spoken: str, ends: bool) -> tuple[str, str]:
    """The name of a quantity in a sentence, and the same with what it is of where that is plain; empty without one.

    spoken: the sentence as it is printed; ends: whether a verb ended it, as in `the torque of the gas is`.
    """
    first = re.match(
        rf"(?:(?:The|Its|A|and the|and its|[A-Z][a-z]+'s)\s+|(?={_BARE}))({_SHORT})\s+"
        r"(?:of|with|for|at|in|on|between|by|along)\b",
        bare,
    )
    if first and _MOVES.search(first[1]):
        first = None
    consists = re.match(
        rf"(?:The|Its)\s+({_SHORT})\s+(?:is\s+(?:that|the\s+(?:sum|product|difference))|consists|comprises|contains)\b",
        bare,
    )
    beside = re.search(rf".*\bthe\s+({_SHORT})\s+with\s+the\b", bare) if ends else None
    headed = re.search(
        rf".*\b(?:the|its|and)\s+({_SHORT})\s+(?:of|on|in|at|along|between|about)\s+(?:the|an?|its|both)\s+{_PLAIN}$",
        bare,
    )
    within = re.match(
        rf"(?:and\s+)?(?:the|its)\s+({_SHORT})\s+(?:in|along|between|about)\s+(?:the|an?|its|both)\s+{_PLAIN}$", bare
    )
    # The heat that leaves is, and the angle that was turned by then
    relative = re.match(rf"(?:{'The|An?|' * ends}and the)\s+({_SHORT})\s+(?:that|which)\b", bare)
    last = re.search(rf"(?:.*(?<!\bof)\s|^)(?:the|its|an?|and)\s+({_SHORT})$", bare, re.IGNORECASE)
    behind = re.search(
        rf"\b(?:has|gives?|yields?|makes?|takes?|stores?|causes?|produces?|exerts?|needs?|requires?)\s+(?:the|an?)\s+({_SHORT})(?:\s+of\s+(?:the|an?)\s+{_PLAIN})?$",
        bare,
    )
    moves = re.search(rf"\b(?:the|its)\s+({_SHORT})\s+(?:rises|falls|drops|grows)\b", bare, re.IGNORECASE)
    # fires with the frequency
    onto = (
        None
        if ends or _LETTER_LAST.search(spoken)
        else re.search(rf".*\b(?:with|by|to|at) (?:the [^,]* and )?the ({_SHORT}(?: of {_PLAIN})?)$", bare)
    )
    verb = _VERB.search(bare)
    chosen = (
        behind
        or relative
        or consists
        or moves
        or onto
        or (first if not verb else None)
        or beside
        or (headed if ends else within)
        or (last if ends or not verb else None)
    )
    if chosen is None or chosen in (last, behind) and _LETTER_LAST.search(spoken):
        return "", ""
    plain = re.sub(r"^(?:the|its|an?|and the|and its)\s+", "", bare, flags=re.IGNORECASE)
    about = chosen is headed and bare[chosen.end(1) :].startswith(" about ")
    if about or chosen is within or chosen is first and _INSIDE.fullmatch(bare[chosen.end(1) :]):
        return chosen[1], bare[chosen.start(1) :]
    return chosen[1], _BESIDE.split(plain)[0] if chosen is first else ""


def _sentence(before: str) -> tuple[str, str, str]:
    # what stands in front of an equation, its last sentence as it is printed, and its words alone
    whole = OPENED.sub("", before).rstrip(" \n:;.,")
    spoken = re.sub(r"\s*\([^()$]*\)$", "", _SENTENCE.split(whole)[-1])
    return whole, spoken, " ".join(_UNWORDED.sub(" ", spoken).split())


def behind(after: str) -> str:
    """What the words behind an equation call what it gives: `is the relative eccentricity`; empty where they do not."""
    match = re.match(
        rf"\s*(?:is|denotes)\s+(?:called\s+)?(?:the|an?)\s+({_SHORT})(?=\s*[,.;:]|\s+(?:and|of|where|with)\b)", after
    )
    return match[1] if match else ""


def shared(before: str) -> str:
    """What a sentence calls each of several things that equations give: `The base diameters are`."""
    words = re.sub(r"\s+(?:are|become|read)$", "", _sentence(before)[2])
    last = re.search(r"\b(?:the|its|their)\s+((?:(?!and\b)[a-z-]+\s+){0,2})([a-z]+)$", words, re.IGNORECASE)
    return f"{last[1]}{PLURALS[last[2]]}" if last and last[2] in PLURALS else ""


def listed(before: str, count: int) -> list[str]:
    """What a sentence says that several equations give, one name for each: `The side force and the torque are`."""
    *_, sentence = _sentence(before)
    bare = re.sub(r"\s+are$", "", sentence)
    shared = re.fullmatch(r"(?:the |whose |its )?([a-z]+) and (?:the )?([a-z]+) ([a-z]+)s\b.*", bare, re.IGNORECASE)
    if shared is not None and count == 2:  # the tangential and radial forces
        return [f"{shared[1]} {shared[3]}", f"{shared[2]} {shared[3]}"]
    parts = re.split(r"\s*,\s*(?:and\s+)?|\s+and\s+", bare)
    if bare == sentence or len(parts) != count:
        return []
    bare_parts = [re.split(r"'s\s+", re.sub(r"^(?:the|its|an?)\s+", "", p, flags=re.I))[-1] for p in parts]
    heads = [re.split(r"\s+(?:of|on|in|for|at)\s+", part)[0] for part in bare_parts]
    return heads if all(re.fullmatch(_SHORT, head) for head in heads) else []
