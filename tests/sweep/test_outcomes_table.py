"""Outcomes as tables give back what was put in, in any order of the points and with rows of several kinds."""

import math

import numpy as np
import pytest

from mechsym.sweep.outcomes import Gap, Outcomes

NEVER = Gap(reason="never")
KINDS = (("a [m]", "b [-]"), ("b [-]", "c [s]"), ("a [m]", "status"))


def outcome(generator):
    kind = int(generator.integers(4))
    if kind == 3:
        return Gap(reason=f"gap {generator.integers(9)}", of_input=bool(generator.integers(2)))
    return {name: "ok" if name == "status" else float(generator.normal()) for name in KINDS[kind]}


@pytest.mark.parametrize("seed", range(20))
def test_what_was_put_comes_back(seed):
    generator = np.random.default_rng(seed)
    count = int(generator.integers(1, 60))
    table, plain = Outcomes(count, NEVER), [NEVER] * count
    for _ in range(6):  # chunks in any order; a point may come again
        members = generator.permutation(count)[: int(generator.integers(1, count + 1))].tolist()
        rows = [outcome(generator) for _ in members]
        if generator.integers(2):
            table.put(members, rows)
        else:  # a table of its own, as a worker sends it and a store keeps it
            own = Outcomes.of(rows)
            table.merge(members, Outcomes.unpacked(len(own), *own.packed()))
        for i, row in zip(members, rows, strict=True):
            plain[i] = row
    assert list(table) == plain and table[-1] == plain[-1] and table[1:4] == plain[1:4]
    assert table == Outcomes.of(plain) and len(table) == count
    assert table.gaps == {i: o for i, o in enumerate(plain) if isinstance(o, Gap)}
    assert table.names == list(dict.fromkeys(n for o in plain if not isinstance(o, Gap) for n in o))
    for stem, name in (("a", "a [m]"), ("b", "b [-]"), ("c", "c [s]")):
        wanted = [math.nan if isinstance(o, Gap) else o.get(name, math.nan) for o in plain]
        np.testing.assert_equal(table.column(stem), wanted)
    words = ["" if isinstance(o, Gap) else o.get("status", "") for o in plain]
    assert table.column("status").tolist() == words


def test_what_is_shown_is_a_table_again():
    rows = [{"a.x [m]": 1.0, "a.y [m]": 2.0, "b [-]": 3.0}, Gap(reason="none"), {"b [-]": 4.0, "status": "ok"}]
    table = Outcomes.of(rows)
    assert list(table.shown(())) == list(table.shown(("all",))) == rows
    assert list(table.shown(("a", "status"))) == [{"a.x [m]": 1.0, "a.y [m]": 2.0}, rows[1], {"status": "ok"}]
    assert list(Outcomes.unpacked(3, *table.shown(("b",)).packed())) == [{"b [-]": 3.0}, rows[1], {"b [-]": 4.0}]
