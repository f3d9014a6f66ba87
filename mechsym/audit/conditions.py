"""What sources take for granted without saying so: constant speed, a rod without mass."""

from collections.abc import Iterator
from dataclasses import replace

from mechsym.audit.bench import used_names
from mechsym.audit.question import Question
from mechsym.audit.theory.record import Theory, dependencies
from mechsym.quantities import record


@record
class Condition:
    """Letters that vanish, in words."""

    words: str
    letters: tuple[str, ...]

    @property
    def told(self) -> str:
        """The words with the letters."""
        return f"{self.words} ({', '.join(f'{k} = 0' for k in self.letters)})"


def conditions(question: Question, written: bool = False) -> Iterator[Condition]:
    """Conditions under which the quantity loses letters that the formula does not have.

    Parameters
    ----------
    written : bool
        Whether only letters that stand in the formula count, and not those of a derived name: in a/omega^2 for the
        second slope, a is the acceleration at constant speed
    """
    theory = question.theory
    used = set(used_names(question.formula))
    used = used if written else dependencies(theory, used)
    asked = [question.quantity, *used] if written else [question.quantity]
    needed = dependencies(theory, asked) - set(question.hold)
    found = []
    for words, letters in taken_for_granted(theory).items():
        lost = tuple(k for k in letters if k in needed)
        if lost and not used & set(lost):
            found.append(Condition(words=words, letters=lost))
    yield from found
    if len(found) > 1:
        yield Condition(words=" and ".join(c.words for c in found), letters=sum((c.letters for c in found), ()))


def taken_for_granted(theory: Theory) -> dict[str, tuple[str, ...]]:
    """Conditions of a theory: words to the letters that vanish."""
    speeds = tuple(k for k, letter in theory.letters.items() if letter.unit == "rad/s^2")
    return ({"constant speed": speeds} if speeds else {}) | dict(theory.conditions)


def under(question: Question, condition: Condition) -> Question:
    """The same question where a condition holds."""
    return replace(question, hold={**question.hold, **dict.fromkeys(condition.letters, 0.0)})
