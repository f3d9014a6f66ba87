"""python -m tests.floors: known holes of the smallest versions that pyproject.toml allows, and of those installed.

pip-audit asks the data base of osv.dev; where that cannot be reached the names are skipped, and said so in one line.
"""

import json
import re
import subprocess
import sys
import tempfile
import tomllib
from importlib import metadata
from pathlib import Path

ROOT = Path(__file__).parent.parent
_FLOOR = re.compile(r"([A-Za-z0-9_.-]+)(?:>=|==)([0-9.]+)")


def floors(text: str) -> list[str]:
    """`name==version` for every floor and pin of a pyproject.toml."""
    tables = tomllib.loads(text)
    asked = [*tables["build-system"]["requires"], *tables["project"]["dependencies"]]
    asked += [one for extra in tables["project"]["optional-dependencies"].values() for one in extra]
    return sorted({"==".join(m.groups()) for one in asked if (m := _FLOOR.match(one))})


def holes(pins: list[str]) -> list[str] | None:
    """A line for each known hole; None where the data base does not answer."""
    with tempfile.TemporaryDirectory() as folder:
        (file := Path(folder) / "pins.txt").write_text("\n".join(pins))
        options = ["--no-deps", "--disable-pip", "--progress-spinner", "off", "--format", "json", "-s", "osv"]
        done = subprocess.run(
            [sys.executable, "-m", "pip_audit", "-r", str(file), *options], capture_output=True, text=True, check=False
        )
    if not done.stdout.startswith("{"):
        return None
    rows = json.loads(done.stdout)["dependencies"]
    if skipped := [row["name"] for row in rows if "skip_reason" in row]:
        print(f"skipped: {', '.join(skipped)} (not in the data base)")
    return [f"{row['name']} {row['version']}: {hole['id']}, mended in {', '.join(hole['fix_versions']) or 'none'}"
            for row in rows for hole in row.get("vulns", ())]  # fmt: skip


def main() -> int:
    """0 without holes or without an answer, 1 with holes."""
    smallest = floors((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    installed = sorted({f"{d.name}=={d.version}" for d in metadata.distributions() if d.name != "mechsym"})
    found = []
    for what, pins in (("floors", smallest), ("installed", installed)):
        lines = holes(pins)
        if lines is None:
            print(f"skipped: {what}, {len(pins)} packages: the data base of known holes (api.osv.dev) does not answer")
            continue
        print(f"{what}: {len(pins)} packages, {len(lines)} known holes", *lines, sep="\n  ")
        found += lines
    return int(bool(found))


if __name__ == "__main__":
    sys.exit(main())
