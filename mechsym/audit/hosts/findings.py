"""Findings of a repository for people and machines: a table by file, SARIF, a baseline of those that are accepted."""

import json
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from mechsym.audit.hosts.repository import File
from mechsym.audit.row import Row
from mechsym.errors import BadInput
from mechsym.files import Json
from mechsym.files.inputs import read_text
from mechsym.page import page
from mechsym.quantities.display import ratio_text

_SCHEMA = "https://json.schemastore.org/sarif-2.1.0.json"
_RULES = {
    "misprint": "A formula is one slip away from the quantity that its name and letters say",
    "wrong": "A formula is not the quantity that its name says, while others beside it in the same letters are",
    "derivative": "A formula or function that is called a derivative is not the derivative of what it names",
}
_KEY = "mechsym/v1"


def sarif(rows: Sequence[Row], version: str) -> Json:
    """The findings as a SARIF 2.1.0 log, which editors and continuous integration show beside the line."""
    rules = [{"id": k, "shortDescription": {"text": text}} for k, text in _RULES.items()]
    driver = {"name": "mechsym audit", "version": version, "rules": rules}
    run = {"tool": {"driver": driver}, "columnKind": "unicodeCodePoints", "results": [_result(row) for row in rows]}
    return {"$schema": _SCHEMA, "version": "2.1.0", "runs": [run]}


def _result(row: Row) -> Json:
    place = {"artifactLocation": {"uri": row["file"]}, "region": {"startLine": max(1, row["line"])}}
    return {
        "ruleId": row["verdict"],
        "level": "warning",
        "message": {"text": message(row)},
        "locations": [{"physicalLocation": place}],
        "partialFingerprints": {_KEY: row["fingerprint"]},
    }


def message(row: Row) -> str:
    """A finding in one line."""
    error = row["max_rel_error"]
    size = f", off by {ratio_text(error, 2)}" if error is not None and error < 1e6 else ""
    should = f"; {row['correction']} agrees" if row["correction"] else ""
    return f"{row['printed']} is not {row['claim']}{size}{should}"


def of_files(files: Sequence[File]) -> list[Row]:
    """All findings, by file and line."""
    return [row for one in files for row in sorted(one.rows, key=lambda r: r["line"])]


def counts(files: Sequence[File]) -> Mapping[str, int]:
    """How much was read, matched and judged."""
    read = [f for f in files if not f.why]
    return {
        "files": len(files),
        "read": len(read),
        "scopes": sum(f.scopes for f in read),
        "assignments": sum(f.assigned for f in read),
        "formulas": sum(f.formulas for f in read),
        "matched": sum(f.matched for f in read),
        "judged": sum(f.judged for f in read),
        "findings": sum(len(f.rows) for f in read),
    }


def accepted(baseline: Path | None) -> set[str]:
    """The findings of a baseline: a SARIF or a JSON file that this command wrote before. Raises BadInput."""
    if baseline is None:
        return set()
    try:
        content = json.loads(read_text(baseline, "--baseline"))
        if isinstance(content, dict) and "runs" in content:
            return {r["partialFingerprints"][_KEY] for run in content["runs"] for r in run["results"]}
        return {row["fingerprint"] for row in content["findings"]}
    except (ValueError, KeyError, TypeError, RecursionError):
        raise BadInput(
            f"--baseline {baseline}: this is neither a SARIF nor a JSON file of findings; write one with --sarif FILE"
        ) from None


def told(files: Sequence[File], rows: Sequence[Row], old: Collection[str]) -> str:
    """What the command prints: coverage by file, then the findings."""
    total = counts(files)
    lines = [f"{'file':<52} {'formulas':>8} {'matched':>8} {'judged':>7} {'findings':>8}"]
    for one in files:
        if one.why:
            lines.append(f"{one.path[-52:]:<52} not read: {one.why}")
        elif one.matched:
            lines.append(f"{one.path[-52:]:<52} {one.formulas:>8} {one.matched:>8} {one.judged:>7} {len(one.rows):>8}")
    silent = sum(not one.why and not one.matched for one in files)
    lines += [f"and {silent} files of whose formulas none fits a theory"] if silent else []
    for row in rows:
        mark = " (in the baseline)" if row["fingerprint"] in old else ""
        lines += ["", f"{row['file']}:{row['line']}: {message(row)}{mark}", *([row["note"]] if row["note"] else [])]
    return "\n".join([*lines, "", summary(total)])


def summary(total: Mapping[str, int]) -> str:
    """The coverage in one line."""
    return (
        f"{total['read']} of {total['files']} files read, {total['scopes']} functions and scripts, "
        f"{total['formulas']} formulas of two letters or more; {total['matched']} fit a theory or a description, "
        f"{total['judged']} judged, {total['findings']} findings"
    )


def as_json(files: Sequence[File], rows: Sequence[Row]) -> Json:
    """Coverage and findings as the command tells them with --json."""
    read = [
        {"path": f.path, "formulas": f.formulas, "matched": f.matched, "judged": f.judged, "findings": len(f.rows)}
        for f in files
        if not f.why
    ]
    unread = [{"path": f.path, "why": f.why} for f in files if f.why]
    return {"coverage": dict(counts(files)), "files": read, "not_read": unread, "findings": list(rows)}


def html(title: str, files: Sequence[File], rows: Sequence[Row]) -> str:
    """Coverage first, then each finding, on one page that opens offline."""
    return page("audit_code.html", title=title, summary=summary(counts(files)), files=files, rows=rows, message=message)
