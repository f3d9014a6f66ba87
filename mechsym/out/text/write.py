"""Statements of a tape in a dialect: each value has one name and is written once."""

from collections.abc import Callable

from mechsym.native.tape import Tape
from mechsym.out.text.dialects import Dialect, number, operation


def statements(tape: Tape, dialect: Dialect, place: Callable[[int], str]) -> tuple[list[str], list[str]]:
    """Statements that compute a tape, and the text of each result; `place` says where input i is read."""
    names: list[str] = []
    lines: list[str] = []
    for i, (operator, operands) in enumerate(tape.nodes):
        if operator == "input":
            names.append(place(operands[0]))
        elif operator == "constant":
            names.append(number(dialect, operands[0]))
        else:
            names.append(f"t{i}")
            value = operation(dialect, operator, [names[k] for k in operands])
            lines.append(dialect.statement.format(names[-1], value))
    return lines, [names[r] for r in tape.results]
