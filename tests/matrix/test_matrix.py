"""Every command on every case gives what is on record, and the records hold what they must.

`make records` writes tests/recorded anew, `make records ONLY="hinge zotov-89/*"` a part of it: what a change of results
looks like then stands in its difference.
"""

import contextlib
import json
import re
from pathlib import Path

import pytest
from matrix import unitless
from matrix.compare import Scales, differences
from matrix.entries import CASES, ROOT, entries, words
from matrix.files import kept, read
from matrix.record import answer, record, sections_read

from mechsym import cases
from mechsym.cases.facts import facts_of
from mechsym.cases.needs import read_by
from mechsym.cli import results

RECORDED = ROOT / "tests/recorded"
#: Entries of the fast suite: a command each, and each kind of mechanism and gas
QUICK = {
    "alpha-stirling/cycle", "balandin/check", "chmielewski/eval", "generator/cycle-diagram", "moroianu/forces",
    "nunes-hypocycloid/sweep", "nunes-slider-crank/cycle", "opposed-pistons/flywheel", "zotov-89/hinge",
    "zotov-89/sweep-guides", "v-twin/simulate", "none/audit-formula", "none/no-unit", "none/new-v-8", "none/sections",
}  # fmt: skip
LONG = ("none/audit-zotov", "none/reproduce-nunes")  # what CI has no time for
ENTRIES = [entry for entry in entries() if not entry.heavy]
RECORDS = {entry.name: read(RECORDED, entry) for entry in ENTRIES if kept(RECORDED, entry).exists()}


def marks(name):
    if name in QUICK:
        return []
    if name.startswith("valve"):  # a valve that lifts off its cam answers to the last bit
        return [pytest.mark.slow, pytest.mark.as_users]
    return [pytest.mark.slow, pytest.mark.heavy] if name in LONG else [pytest.mark.slow]


@pytest.mark.parametrize("entry", [pytest.param(e, id=e.name, marks=marks(e.name)) for e in ENTRIES])
def test_a_command_gives_what_is_on_record(entry, prepared):
    now = json.loads(json.dumps(record(entry, prepared, twice=entry.name in QUICK)))
    assert [*differences(RECORDS[entry.name], now, scales=Scales(now, entry.line.split()[0]))] == [], (
        "if this is wanted: make records"
    )


def test_every_entry_is_on_record_and_nothing_else():
    assert {path.relative_to(RECORDED).with_suffix("").as_posix() for path in RECORDED.glob("*/*.json")} == set(RECORDS)
    assert RECORDS.keys() == {entry.name for entry in ENTRIES} >= QUICK


@pytest.mark.parametrize("case", CASES)
def test_check_says_what_is_refused(case):
    """What `check` finds lacking is refused with exit status 2, and everything else runs."""
    commands = RECORDS[f"{case}/check"]["json"]["commands"]
    runs = {name: RECORDS[f"{case}/{name}"]["exit"] for name in commands if f"{case}/{name}" in RECORDS}
    assert {name for name, code in runs.items() if code == 2} == {name for name in runs if commands[name]}
    assert set(runs.values()) <= {0, 1, 2}


@pytest.mark.parametrize(
    "entry", [pytest.param(e, id=e.name, marks=[pytest.mark.slow, *[pytest.mark.heavy] * runs])
              for e in entries() if e.heavy and e.case
              for runs in [not RECORDS[f"{e.case}/check"]["json"]["commands"][e.line.split()[0]]]],
)  # fmt: skip
def test_check_says_it_of_heavy_commands(entry, prepared):
    """Their refusals are looked at by the slow suite, their runs by the heavy one."""
    missing = RECORDS[f"{entry.case}/check"]["json"]["commands"][entry.line.split()[0]]
    typed = words(entry, prepared)
    with contextlib.chdir(prepared), sections_read(typed) as read:
        code, out, err = answer(typed)
        sections, said = _said(entry, prepared)
        assert missing or sections & read() - DRAWN <= said, (read(), said)
    if entry.command == "identify" and code == 2 and not missing:
        assert "friction.viscous" in err or "trace" in err  # of another machine than the case's
        return
    assert (code == 2) == bool(missing), (code, out, err)


def _said(entry, folder):
    """Sections that a case has as it is asked, and those that its command is said to read."""
    file = f"{entry.case}.toml"
    with contextlib.chdir(folder):
        loaded = cases.load(file if Path(file).exists() else entry.case)
        sections = {**dict.fromkeys(re.findall(r"--set (\w+)\.", entry.line)), **loaded.sections}
        return sections.keys(), read_by(facts_of(loaded.mechanism, sections)).get(entry.line.split()[0], set())


#: Sections that files are written by: the title of a report, the pose in which a machine that is drawn begins to turn
DRAWN = {"report", "simulation"}
#: Sections that a command reads where an option asks for it
BY_OPTION = {"combustion", "measured", "comparison", "gas_limits"}


@pytest.mark.parametrize("case", CASES)
def test_commands_read_what_check_says(case, prepared):
    missing, every, known = RECORDS[f"{case}/check"]["json"]["commands"], set(), set()
    for entry in ENTRIES:
        # points of a sweep are cases of their own; the trace is of another machine
        if entry.case != case or missing.get(entry.command, ["no run"]) or entry.command in ("sweep", "identify"):
            continue
        sections, said = _said(entry, prepared)
        read = sections & RECORDS[entry.name]["reads"]
        assert read - DRAWN <= said, (entry.command, read - said)
        every, known = every | read, known | said & sections
    assert known - BY_OPTION <= every, known - every


@pytest.mark.parametrize("case", CASES)
def test_what_nothing_reads_is_told_by_every_command(case):
    told = {
        name: _unused(one["json"]) for name, one in RECORDS.items() if name.startswith(f"{case}/") and "json" in one
    }
    wanted = told.pop(f"{case}/check")
    assert [name for name, doubts in told.items() if doubts is not None and not wanted <= doubts] == []


def _unused(found):
    doubts = found.get("doubts") if isinstance(found, dict) else None
    return {d["quantity"] for d in doubts if d["code"] == "unused"} if isinstance(doubts, list) else None


@pytest.mark.parametrize("command", sorted({entry.line.split()[0] for entry in ENTRIES} - unitless.WITHOUT))
def test_every_number_has_unit_and_meaning(command):
    """Each number of each --json is one that `mechsym sections --results` lists."""
    rows = results.rows(command) if command in results.RESULTS else []
    assert [row for row in rows if not row["unit"] or not row["about"]] == []
    told = {(e.name, path) for e in ENTRIES if e.line.split()[0] == command and e.name in RECORDS
            for path in unitless.numbers(RECORDS[e.name].get("json"))}  # fmt: skip
    unknown = sorted({path for _, path in told if not unitless.listed(path, rows)})
    assert unknown == []


#: Heavy commands, each on a case that it does not take long for
HEAVY = ("chmielewski/fmu", "chmielewski/identify", "generator/page", "generator/report", "none/study",
         "nunes-hypocycloid/optimise",
         "zotov-89/codesign", "zotov-89/report")  # fmt: skip


@pytest.mark.slow
@pytest.mark.parametrize(
    "entry",
    [
        pytest.param(e, id=e.name, marks=[pytest.mark.heavy] * (e.name == "generator/report"))
        for e in entries()
        if e.name in HEAVY
    ],
)
def test_every_number_of_a_heavy_command_has_unit_and_meaning(entry, prepared):
    now, rows = record(entry, prepared), results.rows(entry.line.split()[0])
    assert now["exit"] in (0, 1)
    assert [path for path in sorted({*unitless.numbers(now["json"])}) if not unitless.listed(path, rows)] == []
