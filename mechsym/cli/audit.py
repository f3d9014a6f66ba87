"""`mechsym audit`: published hand formulas, or the user's own, against the derivations."""

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from mechsym.cli.common import budget_option, emit, ending, json_option, out_option, progress, refuse_idle, table
from mechsym.errors import BadInput
from mechsym.files import Json

if TYPE_CHECKING:
    pass

_FILE = click.Path(path_type=Path, dir_okay=False)
_ROUND_OFF = 1e-10  # relative error that the floats of a right formula leave [-]
_COLUMNS = ["source", "equation", "claim", "verdict", "max_rel_error", "order", "corrected_max_rel_error"]


@click.command(short_help="Check published hand formulas against the derivations.")
@click.argument("paper", required=False, type=click.Path(path_type=Path))
@click.option("--source", help="Only this source: file stem or short name.")
@click.option("--formula", metavar="TEXT", help="A formula of your own, in Python syntax, LaTeX or as printed.")
@click.option("--against", metavar="NAME.QUANTITY", help="What the formula claims to be, e.g. crosshead.inertia.")
@click.option("--letters", default="", metavar="PAIRS", help='Your letters, e.g. "R=r1+r2, L=l1+l2".')
@click.option("--case", default="", help="Case whose data the error is measured with.")
@click.option("--assume", default="", metavar="RELATIONS", help='What is taken for granted, e.g. "phidd = 0, r < l".')
@click.option("--claim", default="", metavar="CLAIM", help='What is claimed: "=", "approx", "lam^2" or "within 1 %".')
@click.option("--convention", default="", metavar="NAMES", help="Conventions of the author; show lists those that fit.")
@click.option(
    "--theory", default="", metavar="FILE", help="TOML file of your own quantities; for a paper also a theory's name."
)
@click.option(
    "--code",
    metavar="PLACE",
    help="FILE::FUNCTION, or a whole FILE or FOLDER: Python, C, Java, MATLAB, Julia, Fortran, ..",
)
@click.option("--sarif", type=_FILE, callback=ending(".sarif", ".json"), help="Write the findings of --code as SARIF.")
@click.option("--baseline", type=_FILE, help="SARIF or JSON of findings that are accepted.")
@click.option("--file", type=_FILE, help="TOML file of formulas.")
@click.option("--certificate", type=_FILE, callback=ending(".v"), help="Write what is exact as a Coq script FILE.v.")
@click.option("--write", is_flag=True, help="Write docs/errata.md and record the findings.")
@out_option
@budget_option
@json_option
@click.pass_context
def audit(
    ctx: click.Context, /, paper: Path | None, source: str | None, formula: str | None, against: str | None,
    code: str | None, file: Path | None, certificate: Path | None, write: bool, out: Path | None,
    sarif: Path | None, baseline: Path | None, **said: object,
) -> None:  # fmt: skip
    """Compare published hand formulas with the derivations; repair misprints by search.

    PAPER is a text (.tex, .md, .rst, .txt, .ipynb) or a folder of them: each of its display equations is one
    row. Without --theory it is judged against itself, its units, and the theories that fit. --out writes a page.

    Exit status of formulas: 0 exact, a truncation, right under a convention, or a claim kept; 1 misprint, nearer,
    wrong, or a claim broken; 3 mixed or untestable. 1 too when the audit differs from the recorded findings.

    \b
    Example: mechsym audit --source zotov2024
    Example: mechsym audit paper.md --out page
    Example: mechsym audit --code src --sarif findings.sarif --baseline accepted.sarif
    Example: mechsym audit paper.tex --theory slider_crank --letters "\\omega=phid" --out page
    Example: mechsym audit --formula "R*sin(phi) + R*lam*sin(2*phi)" --against crosshead.dx_dphi --letters "R=r1+r2"
    """
    from mechsym.files import write_text

    whole = code is not None and "::" not in code
    if (sarif or baseline) and not whole:
        raise BadInput("--sarif and --baseline belong to --code FILE or FOLDER")
    if own := [o for o in (paper, formula, file, code) if o is not None]:
        if source or write or len(own) > 1:
            raise BadInput(
                "a paper, --formula, --file and --code stand alone; use one of them without --source and --write"
            )
        if paper is not None and not said["theory"]:
            refuse_idle("for a whole paper: give --theory too", "against", "letters", "case", "assume", "claim",
                        "convention", "certificate")  # fmt: skip
            ctx.exit(_whole(paper, out))
        if code is not None and whole:
            refuse_idle("for a whole file or folder: it is held against what its names fit", "against", "certificate")
            ctx.exit(_repository(Path(code), out, sarif, baseline, said))
        rows = _own(formula, against, file, code, said) if paper is None else _paper(paper, said)
        if certificate is not None:
            from mechsym.audit.hosts.sources import certificate_of_formula
            from mechsym.audit.judge.asked import Asked

            if formula is None:
                raise BadInput("--certificate goes with --formula, or with the sources")
            asked: Any = Asked(text=formula, against=str(against), **said)  # type: ignore[arg-type]
            click.echo(str(write_text(certificate, certificate_of_formula(asked, rows[0]))), err=True)
        summary = _counted(rows, paper)
        if out is not None:
            from mechsym.audit.row import html

            click.echo(str(write_text(out / "audit.html", html(str(own[0]), summary, rows))), err=True)
        lines = [*map(_told, rows), *([summary] if paper else [])]
        emit(rows[0] if formula is not None else rows, lambda: "\n\n".join(lines))
        ctx.exit(_status(rows))
    if out or against or any(said.values()):
        raise BadInput(
            "--against, --letters, --out and --case belong to --formula; write for example --formula 'r*sin(phi)'"
        )
    ctx.exit(_published(source, write, certificate))


def _whole(paper: Path, out: Path | None) -> int:
    from mechsym.audit.hosts.whole import check_texts, count_of, listed, page_of, read_texts, summary_of
    from mechsym.files import write_text
    from mechsym.quantities.results import tell

    texts = read_texts(paper)
    with progress(count_of(texts), "auditing") as bar:
        rows, cover = check_texts(texts, lambda: bar.update(1))
    if out is not None:
        click.echo(str(write_text(out / "audit.html", page_of(str(paper), rows, cover))), err=True)
    result = {"rows": rows, "coverage": tell(cover)}
    emit(result, lambda: "\n".join([summary_of(rows, cover), *listed(rows)]))
    # of single equations nobody expects a verdict; where none was read nothing is right
    return _status([r for r in rows if r["verdict"] != "untestable" or not cover.read])


def _repository(place: Path, out: Path | None, log: Path | None, baseline: Path | None, said: dict[str, Any]) -> int:
    import json

    from mechsym import __version__
    from mechsym.audit.hosts import findings
    from mechsym.audit.hosts import repository as read
    from mechsym.audit.judge.asked import Asked
    from mechsym.files import write_text

    old = findings.accepted(baseline)
    chosen = read.programs(place)
    with progress(len(chosen), "reading") as bar:
        files = []
        for one in read.audited(place, Asked(text="", against="", **said), chosen):
            files.append(one)
            bar.update(1)
    rows = findings.of_files(files)
    if log is not None:
        click.echo(str(write_text(log, json.dumps(findings.sarif(rows, __version__), indent=1))), err=True)
    if out is not None:
        click.echo(str(write_text(out / "audit.html", findings.html(str(place), files, rows))), err=True)
    emit(findings.as_json(files, rows), lambda: findings.told(files, rows, old))
    return 1 if any(row["fingerprint"] not in old for row in rows) else 0


def _paper(paper: Path, said: dict[str, Any]) -> list[Json]:
    from mechsym.audit.hosts.paper import check_paper
    from mechsym.audit.judge.asked import Asked

    refuse_idle("for the equations of a paper: their left sides say what they are", "against")
    return check_paper(paper, Asked(text="", against="", **said))


def _counted(rows: Sequence[Json], paper: Path | None) -> str:
    from mechsym.audit.hosts.paper import few, summary
    from mechsym.audit.verdict import FINDINGS

    if paper is not None:
        return summary(rows)
    count = sum(r["verdict"] in FINDINGS for r in rows)
    return f"{few(len(rows), 'formula')}, {few(count, 'finding')}"


def _own(
    formula: str | None, against: str | None, file: Path | None, code: str | None, said: dict[str, Any]
) -> list[Json]:
    from mechsym.audit.hosts.formula import check_file, check_formula
    from mechsym.audit.hosts.program import check_code
    from mechsym.audit.judge.asked import Asked

    if code is not None:
        return check_code(code, against or "", Asked(text="", against=against or "", **said))
    if file is not None:
        return check_file(file, said["theory"])
    if against is None:
        from mechsym.audit.theory.catalogue import names

        raise BadInput(f"--formula needs --against THEORY.QUANTITY; theories are {', '.join(names())}")
    return [check_formula(str(formula), against, **said)]


def _status(rows: Sequence[Json]) -> int:
    from mechsym.audit.verdict import FINDINGS, OPEN

    kept = [row["claim_kept"] for row in rows if "claim_kept" in row]
    verdicts = [row["verdict"] for row in rows if "claim_kept" not in row]
    if not all(kept) or any(v in FINDINGS for v in verdicts):
        return 1
    return 3 if any(v in OPEN for v in verdicts) else 0


def _published(source: str | None, write: bool, certificate: Path | None) -> int:
    from mechsym.audit.hosts import sources as published
    from mechsym.files import write_text
    from mechsym.papers import rows as record
    from mechsym.papers import sources
    from mechsym.papers.sources import short_name

    if write and source:
        raise BadInput("--write records the findings of all sources; leave out --source")
    chosen = sources(source)
    with progress(sum(len(s.entries) for s in chosen), "auditing") as bar:
        rows = published.rows(chosen, lambda: bar.update(1))
    differences = record.differences("mechsym.audit", rows, published.NAME, published.COMPARED)
    errors = ("max_rel_error", "corrected_max_rel_error")
    shown = [row | {"source": short_name(row["source"])} | {key: _error(row[key]) for key in errors} for row in rows]
    emit(rows, lambda: table(shown, _COLUMNS))
    if certificate is not None:
        text, without = published.certificate_of_sources(chosen, rows)
        click.echo(str(write_text(certificate, text)), err=True)
        click.echo("\n".join(f"proved, without a script: {name}" for name in without), err=True)
    if write:
        trial = published.TRIAL.read_text(encoding="utf-8") if published.TRIAL.is_file() else ""
        record.write("mechsym.audit", rows, (*published.NAME, *published.COMPARED))
        click.echo(str(write_text(published.ERRATA, published.errata(chosen, rows, trial))), err=True)
        return 0
    for line in differences:
        click.echo(f"differs from the record: {line}", err=True)
    return 1 if differences else 0


def _error(value: float | None) -> str | None:
    """A relative error; what rounding leaves is none."""
    if value is None:
        return None
    return f"{value:.3g}" if value > _ROUND_OFF else f"below {_ROUND_OFF:g}"


def _told(row: Json) -> str:
    head = row["claim"] if row["equation"] == "-" else f"{row['equation']}, {row['claim']}"
    lines = [f"{head}: {row['verdict']}"]
    if row["understood"] is None:
        return "\n".join([*lines, row["note"]])
    lines.append(f"understood as: {row['understood']}")
    if row["correction"]:
        lines.append(f"corrected:     {row['correction']}")
    if row["evidence"]["domain"]:
        lines.append(f"holds for:     {row['evidence']['domain']}")
    lines.append(f"largest relative error: {_error(row['max_rel_error'])}")
    if row["corrected_max_rel_error"] is not None:
        lines.append(f"when corrected:         {_error(row['corrected_max_rel_error'])}")
    if row["order"] is not None:
        lines.append(f"order of lambda: {row['order']}" if row["order"] >= 0 else "the leading term is wrong")
    counterexample = row["evidence"]["counterexample"]
    if counterexample:
        lines.append("for example at " + ", ".join(f"{k} = {v:.6g}" for k, v in counterexample.items()))
    return "\n".join([*lines, *([row["note"]] if row["note"] else [])])
