"""Rows of hand.toml and of the seen halves of the other lists as typed: a slip is told, its twin is left in peace."""

import zlib

import pytest
from hand import LISTS, NAMES, half, name, told

_FAST = 6  # one light row of so many runs with the fast tests


def rows(kind):
    of_peers = [row for name in NAMES[1:] for row in LISTS[name][kind] if half(row) == "seen"]
    for row in (*LISTS["hand"][kind], *of_peers):
        command = row.get("run", row.get("line")).split()[0]
        light = (
            command in ("check", "forces", "cycle", "new")
            and not any(row in LISTS[late][kind] for late in NAMES[NAMES.index("laws") :])
            and zlib.crc32(name(row).encode()) % _FAST == 0
        )
        marks = [] if light else [pytest.mark.slow, *([pytest.mark.heavy] if row in of_peers else [])]
        if "missed" in row:
            marks.append(pytest.mark.xfail(reason=row["missed"], strict=True))
        yield pytest.param(row, id=name(row), marks=marks)


@pytest.mark.parametrize("row", list(rows("slips")))
def test_a_slip_of_the_hand_is_told_and_once(row, tmp_path):
    doubts = told(row, tmp_path)
    assert doubts
    assert len(set(doubts)) == len(doubts)


@pytest.mark.parametrize("row", list(rows("twins")))
def test_a_neutral_twin_is_left_in_peace(row, tmp_path):
    assert told(row, tmp_path) == []
