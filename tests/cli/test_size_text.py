"""What `size` prints of an engine of many cylinders: equal loads once, with the numbers that they are of."""

import json

from click.testing import CliRunner

from mechsym.cases.new_engine import write_engine
from mechsym.cli import mechsym


def test_loads_that_are_the_same_at_several_cylinders_stand_in_one_row(tmp_path):
    case = str(write_engine("v", 0.096, 0.092, 8, tmp_path, gas="closed")[0])
    text = CliRunner().invoke(mechsym, ["size", case], catch_exceptions=False).output.splitlines()
    rows = json.loads(CliRunner().invoke(mechsym, ["size", case, "--json"], catch_exceptions=False).output)
    components = sum("_x_" in row["component"] or "_y_" in row["component"] for row in rows)
    head, *lines = text[1:]
    assert head.split()[:2] == ["component", "of"] and len(lines) < len(rows) / 2
    place = slice(head.index("of"), head.index("quantity"))
    told = [number for line in lines for number in line[place].replace(",", " ").split()]
    assert len(told) + sum(not line[place].strip() for line in lines) == len(rows) - components
    largest = [line for line in lines if line.startswith("side force ") and "largest" in line]
    assert [line[place].strip() for line in largest] == ["1, 2, 3, 4, 5, 6, 7, 8"]
    # what a throw leans on the bearings beside it is no bearing's load
    assert not any(line.startswith("main bearing") for line in lines) and any("throw force" in line for line in lines)
