"""python -m benchmarks.auditor: tries the auditor and records what it says, for `mechsym audit --write` to print."""

import click

from benchmarks.auditor import matrix

with click.progressbar(length=matrix.STEPS, label="trying the auditor") as bar:
    found = matrix.trial(lambda: bar.update(1))
matrix.record(found)
print("\n".join(matrix.lines(found)))
