"""python -m benchmarks.auditor.noise COUNT SEED: random texts against quantities; no traceback."""

import random
import sys
import time
from collections import Counter

from mechsym.audit.hosts.formula import check_formula
from mechsym.audit.theory.catalogue import names, theory
from mechsym.errors import BadInput

_WORDS = (
    *"0123456789.+-*/^(){}[]=,;:_'\\$&|<>!% ",
    "**",
    "\\frac{",
    "}{",
    "sqrt(",
    "sin(",
    "e^{",
    "\\dot{",
    "π",
    "²",
    "nan",
)
_FUNCTIONS = ("sin", "cos", "sqrt", "tan", "exp", "abs", "asin", "log")


def text(generator: random.Random, letters: list[str], depth: int) -> str:
    """A formula of some of the letters, or noise."""
    if depth == 0:
        return generator.choice([*letters, str(generator.randint(0, 9)), f"{generator.uniform(0, 1e3):.3g}", "pi"])
    kind = generator.randrange(8)
    if kind < 5:
        one, other = (text(generator, letters, depth - 1) for _ in range(2))
        return f"({one} {generator.choice(['+', '-', '*', '/', '**'])} {other})"
    if kind < 7:
        return f"{generator.choice(_FUNCTIONS)}({text(generator, letters, depth - 1)})"
    return f"-{text(generator, letters, depth - 1)}"


def broken(generator: random.Random, whole: str) -> str:
    """A text with some of it lost, doubled or replaced by noise."""
    for _ in range(generator.randint(1, 4)):
        place = generator.randrange(len(whole) + 1)
        whole = whole[:place] + generator.choice(_WORDS) + whole[place + generator.randint(0, 2) :]
    return whole


def run(count: int, seed: int) -> tuple[Counter[str], float, str]:
    """What is said of so many random inputs, and the longest time that one took [s]."""
    generator, said, longest, slowest = random.Random(seed), Counter[str](), 0.0, ""
    known = {name: theory(name) for name in names()}
    for _ in range(count):
        name = generator.choice(sorted(known))
        quantity = generator.choice(known[name].results)
        written = text(generator, list(known[name].letters), generator.choice((1, 1, 2, 2, 3, 4)))
        if generator.random() < 0.6:
            written = broken(generator, written)
        begin = time.process_time()
        try:
            said[check_formula(written, f"{name}.{quantity}")["verdict"]] += 1
        except BadInput:
            said["refused"] += 1
        except Exception as error:
            said["traceback"] += 1
            print(f"{type(error).__name__}: {error}: {name}.{quantity}: {written!r}")
        took = time.process_time() - begin
        if took > longest:
            longest, slowest = took, f"{name}.{quantity}: {written}"
    return said, longest, slowest


if __name__ == "__main__":
    counts, seconds, where = run(int(sys.argv[1]), int(sys.argv[2]))
    print(dict(counts), f"longest {seconds:.1f} s: {where}")
