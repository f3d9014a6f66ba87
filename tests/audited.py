"""Findings of the auditor in programs that a test writes."""

from mechsym.audit.hosts.findings import of_files
from mechsym.audit.hosts.repository import audited, programs
from mechsym.audit.judge.asked import Asked

NONE = Asked(text="", against="")


def rows_of(tmp_path, files):
    for name, text in files.items():
        place = tmp_path / name
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(text if isinstance(text, bytes) else text.encode())
    return of_files(list(audited(tmp_path, NONE, programs(tmp_path))))
