"""Runs the rows of a list in plausible/ as typed; `python tests/hand.py LIST [HALF [TEXT]]` prints the counts.

HALF is seen, unseen or all. A slip is told when the command refuses it or doubts it, and of a formula when the auditor
does not end with 0 or says what it has not read; a twin is in peace when the command does neither.
"""

import contextlib
import functools
import json
import multiprocessing
import re
import shlex
import shutil
import sys
import tempfile
import tomllib
import zlib
from pathlib import Path

import numpy as np
from click.testing import CliRunner

from mechsym import cases
from mechsym.cases.new_engine import write_engine
from mechsym.cli import mechsym
from mechsym.errors import BadInput
from mechsym.jobs.run import run

TESTS = Path(__file__).parent
_DESIGNS = ("codesign", "hinge", "optimise")  # whose exit status of 1 is an answer to what they were given
LIMIT = 60  # time of a row by the clock [s]
EXAMPLES = TESTS.parent / "examples"
OWN = (EXAMPLES / "mechanisms", EXAMPLES / "space", TESTS / "plausible" / "own")
NAMES = ("hand", "peers", "trackers", "office", "laws", "shop")
NAMES += ("field", "yard", "depot", "hall", "annex", "garage", "wharf", "quay", "pier", "jetty", "dock")
LISTS = {name: tomllib.loads((TESTS / "plausible" / f"{name}.toml").read_text()) for name in NAMES}


def half(row):
    """A row belongs to the half that is looked at while the laws are written, or to the other one."""
    return ("seen", "unseen")[
        zlib.crc32(json.dumps({k: v for k, v in row.items() if k != "missed"}, sort_keys=True).encode()) % 2
    ]


def name(row):
    values = ",".join(f"{key}={value}" for key, value in row.get("set", {}).items())
    done = " ".join(f"{key}: {row[key]}" for key in ("edit", "trace") if key in row)
    words = (row.get("kind", ""), row.get("on", ""), values, done, row.get("run", row.get("line")))
    return " ".join(filter(None, words))


def told(row, folder):
    """What is said of a row: `refused`, a verdict that is not exact, or code and quantity of every doubt."""
    with contextlib.chdir(folder):
        done = CliRunner().invoke(mechsym, [*_line(row, Path(folder)), "--json"])
    if done.exit_code == 2 or isinstance(done.exception, BadInput):
        return [("refused", "")]
    if not isinstance(done.exception, SystemExit | None):
        raise done.exception
    result = json.loads(done.stdout)
    if row.get("line", "").startswith("audit"):
        bad = done.exit_code or "not read: " in result["note"]
        return [("verdict", result["verdict"])] if bad else []
    result = {} if isinstance(result, list) else result  # of sizes
    doubts = [(d["code"], d["quantity"]) for d in result.get("doubts", ())]
    doubts += [("not met", "")] * (done.exit_code == 1 and row.get("run", "").split(" ")[0] in _DESIGNS)
    doubts += [("problem", one["key"]) for one in result.get("problems", ())]
    doubts += [("failed", one["reason"]) for one in result.get("failed", ())]
    return doubts + [tuple(line.split()[1:3]) for line in done.stderr.splitlines() if line.startswith("doubt:")]


def _line(row, folder):
    if "line" in row:
        return shlex.split(row["line"])
    case = str(_case(row, folder))
    if "trace" in row:
        write_trace(row["trace"], folder / "t.csv")
    command, *options = shlex.split(row["run"])
    own = command == "check" and row["on"].startswith("own") and "--trust" not in options
    return [command, case, *options, *["--trust"] * own]


@functools.cache
def _clean():
    """A start-up of chmielewski as an encoder sees it: times and speeds of its crank."""
    short = {"simulation.t_end": "3 s", "simulation.window": "1 s", "simulation.output_step": "2 ms"}
    result = run(cases.load("chmielewski", short), check="none").result
    return result.t, result.columns["phi0d"]


def write_trace(done, file):
    """Write a record: 2 ms apart with the noise of an encoder, and what a row of the list has done to it."""
    t, speed = _clean()
    speed = speed + done.get("noise", 0.002) * np.random.default_rng(1).standard_normal(len(t))
    keep = t >= done.get("from", -1.0)
    keep[:: done.get("drop", len(t) + 1)] &= "drop" not in done
    if "gap" in done:
        keep &= (t < done["gap"][0]) | (t > done["gap"][1])
    rows = np.column_stack([t * done.get("time", 1), speed * done.get("speed", 1)])[keep]
    if "nan" in done:
        rows[done["nan"], 1] = np.nan
    if "swap" in done:
        rows[[done["swap"], done["swap"] + 1]] = rows[[done["swap"] + 1, done["swap"]]]
    head = f"{done.get('clock', 't [s]')},{done.get('head', 'phi0d [rad/s]')}"
    np.savetxt(file, rows, delimiter=",", header=head, comments="")


def _case(row, folder):
    content = tomllib.loads(_base(row["on"], folder))
    for old, new in row.get("edit", {}).items():
        _edit(folder / content["mechanism"], old, new)
    for key in row.get("drop", ()):
        section, _, last = key.partition(".")
        if last:
            del content[section][last]
        else:
            del content[section]
    for key, value in row.get("set", {}).items():
        section, _, last = key.partition(".")
        if last:
            content.setdefault(section, {})[last] = value
        else:
            content[section] = value
    file = folder / "case.toml"
    file.write_text("".join(_section("", content)))
    return file


def _edit(file, old, new):
    text = file.read_text()
    assert old in text, f"{file.name} has no {old}"
    file.write_text(text.replace(old, new))


def _base(on, folder):
    if on in cases.names():
        beside = Path(cases.__file__).parent
        for file in beside.glob("*.csv"):
            shutil.copy(file, folder)
        return cases.text(on)
    kind, *sizes = on.split()
    exchange = kind == "exchange"  # an engine as it is written, with its gas exchange
    if exchange:
        kind, *sizes = sizes
    if kind == "own":
        for file in (file for own in OWN for file in own.iterdir() if file.is_file()):
            shutil.copy(file, folder)
        return (folder / f"{sizes[0]}.toml").read_text()
    bore, stroke = (float(size) / 1e3 for size in sizes[:2])
    if exchange or kind not in ("inline", "v"):
        return write_engine(kind, bore, stroke, int(sizes[2]), folder / "engine")[0].read_text()
    # rows name keys of a closed cycle whose pressure falls at once where the exhaust opens
    closed = write_engine(kind, bore, stroke, int(sizes[2]), folder / "engine", gas="closed")[0].read_text()
    return re.sub(r"(?ms)^\[blowdown\].*?(?=^\[)", "", closed)


def _section(path, table):
    plain = {k: v for k, v in table.items() if not isinstance(v, dict)}
    if path:
        yield f"[{path}]\n"
    yield from (f"{_key(k)} = {json.dumps(v)}\n" for k, v in plain.items())
    for key, value in table.items():
        if isinstance(value, dict):
            yield from _section(f"{path}.{_key(key)}" if path else _key(key), value)


def _key(key):
    return key if key.replace("_", "").isalnum() else f'"{key}"'


def main(which, wanted="seen", pattern=""):
    for kind, every in LISTS[which].items():
        rows = [row for row in every if wanted in ("all", half(row)) and pattern in name(row)]
        hits = 0
        for row in rows:
            answer = _forked(row)
            right = answer is not None and bool(answer) == (kind == "slips")
            hits += right
            if not right:
                words = "fails, or takes too long" if answer is None else ", ".join(code for code, _ in answer)
                print(f"  {kind}: {name(row)} -> {words or 'nothing'}", flush=True)
        print(f"{kind} of the half {wanted}: {hits} of {len(rows)} right", flush=True)


def _forked(row):
    """What is said of a row, by a process of its own; None where it fails or takes longer than `LIMIT`."""
    context = multiprocessing.get_context("fork")
    ours, theirs = context.Pipe()

    def work():
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stderr(None):
            theirs.send(told(row, Path(folder)))

    child = context.Process(target=work)
    child.start()
    answer = ours.recv() if ours.poll(LIMIT) else None
    child.kill()
    child.join()
    return answer


if __name__ == "__main__":
    main(*sys.argv[1:])
