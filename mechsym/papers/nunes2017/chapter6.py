"""Chapter 6 of Nunes (2017), sentence by sentence: which rows decide each, or why none can.

A sentence that several rows touch has several verdicts. One that says nothing of the engine, or names what the text
gives no number for, is `not computable` with the reason.
"""

from collections.abc import Sequence
from typing import Any

from mechsym.errors import BadInput
from mechsym.papers.nunes2017 import SOURCE
from mechsym.papers.rows import NOT_COMPUTABLE, row
from mechsym.quantities import record

_NO_CLAIM = "says nothing of the engine that could be computed"
_NO_NUMBER = "the text names it and gives no dimension, load or property"


@record
class Sentence:
    """One sentence of the chapter."""

    section: str  #: 6, 6.1 or 6.2
    begins: str  #: Its first words
    decided: tuple[str, ...] = ()  #: How the items of the rows that decide it begin
    left: str = ""  #: Why nothing decides it, or part of it


SENTENCES = (
    Sentence(section="6", begins="The slider crank conventional engine", left="history: " + _NO_CLAIM),
    Sentence(section="6", begins="The OPGHE presents itself", decided=(
        "section 6: average torque of the hypocycloid engine", "section 6: friction mean pressure of the hypocycloid",
    )),
    Sentence(section="6", begins="Furthermore, this configuration avoids", left=(
        "neither oil consumption nor emissions nor a two-stroke engine is in the thesis's model"
    )),
    Sentence(section="6", begins="Also of note is the balance", decided=("section 6: shaking force beside",)),
    Sentence(section="6", begins="Also, the possibility of having longer", decided=(
        "section 6: efficiency of the slider crank engine with a rod",
    )),
    Sentence(section="6", begins="As seen before, the study of heat", left="what was left out: " + _NO_CLAIM),
    Sentence(section="6", begins="Several steps in this study", left="how the work went: " + _NO_CLAIM),
    Sentence(section="6", begins="The values of efficiency, power", left=(
        "promising is no number; each value has its own row, and friction and gas exchange, which section 6.2 names, "
        "have theirs"
    )),
    Sentence(section="6", begins="Finally, the objective of this study", left="how the work went: " + _NO_CLAIM),
    Sentence(section="6.1", begins="During this study, some possible", left="how the work went: " + _NO_CLAIM),
    Sentence(section="6.1", begins="One of the design steps", decided=("section 6.1: power that the",)),
    Sentence(section="6.1", begins="Also, the design of gears", left="how gears are designed: " + _NO_CLAIM),
    Sentence(section="6.1", begins="When designing the geared hypocycloid", decided=(
        "allowable bending stress of Nitralloy N",
    )),
    Sentence(section="6.1", begins="However, for a OPGHE, it proved", decided=("section 6.1: load that a single",)),
    Sentence(section="6.1", begins="This may be minimized", decided=("section 6.1: largest tooth load",)),
    Sentence(section="6.1", begins="Another alternative was the use", decided=("maraging 350: gain in",)),
    Sentence(section="6.1", begins="These steels have been developed", left="history: " + _NO_CLAIM),
    Sentence(section="6.1", begins="They are hardened by", left="data of a handbook, nothing to compute it from"),
    Sentence(section="6.1", begins="The allowable bending and contact", left="a rule of thumb of a handbook"),
    Sentence(section="6.1", begins="Therefore, for Maraging 350", decided=(
        "maraging 350: allowable bending", "maraging 350: gain in bending", "maraging 350: gain in contact",
        "maraging 350: 342 ksi",
    )),
    Sentence(section="6.1", begins="The face width, and therefore", decided=(
        "maraging 350: face width over", "section 6.1: maraging 350: face width", "section 6.1: maraging 350: mass",
    )),
    Sentence(section="6.1", begins="Some alternative materials for the cylinder", left=_NO_NUMBER),
    Sentence(section="6.1", begins="One other improvement", decided=(
        "section 6.1: tooth load with the bore", "section 6.1: volume of a gear pair",
    )),
    Sentence(section="6.1", begins="However, the impact on the engine", decided=(
        "section 6.1: efficiency with a bore of 55 mm",
    )),
    Sentence(section="6.1", begins="The possibility of operating on higher", decided=(
        "section 6.1: efficiency with the compression ratio", "section 6.1: efficiency over the compression ratio",
    )),
    Sentence(section="6.1", begins="Finally, a turbocharging system", decided=(
        "section 6.1: turbocharged power at 3000 m", "section 6.1: average torque at an intake pressure",
    )),
    Sentence(section="6.2", begins="Seeing this as a first stage", left="what comes next: " + _NO_CLAIM),
    Sentence(section="6.2", begins="Firstly, more accurate models", left="tests of the material are needed"),
    Sentence(section="6.2", begins="Secondly, the intake and exhaust", decided=("section 6.2: filling of the",)),
    Sentence(section="6.2", begins="The mechanical losses must also", decided=("section 6.2: loss by friction",)),
    Sentence(section="6.2", begins="The use of finite-element", left="no part is modelled as a body that deforms"),
    Sentence(section="6.2", begins="Since the engine is to operate", decided=("section 6.2: valve system",)),
    Sentence(section="6.2", begins="In addition, the belt system", decided=("section 6.2: timing belt",)),
    Sentence(section="6.2", begins="Furthermore, both the fuel", decided=("section 6.2: fuel and ignition",)),
    Sentence(section="6.2", begins="Finally, the use of a flywheel", decided=("section 6.2: flywheel for a ripple",)),
    Sentence(section="6.2", begins="The final stage is build", left="what comes next: " + _NO_CLAIM),
)  # fmt: skip


def rows(found: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
    """Rows of the sentences that nothing decides.

    Parameters
    ----------
    found : sequence of dict
        Rows of the thesis, which decide the other sentences

    Raises
    ------
    BadInput
        No row decides a sentence that one should
    """
    items = [one["item"] for one in found]
    for sentence in SENTENCES:
        for start in sentence.decided:
            if not any(item.startswith(start) for item in items):
                raise BadInput(f"chapter 6, {sentence.begins!r}: no row begins with {start!r}")
    return [
        row(SOURCE.stem, f"section {one.section}: {one.begins!r} ..", None, None, NOT_COMPUTABLE, one.left)
        for one in SENTENCES
        if one.left
    ]
