"""What a text says of one case is not held against another: labels, columns, sections, and the equation in front."""

import pytest
from audited import judged

PULLEYS = """**Fixed pulley**

$$ T = w $$

$$ F = 2 T $$

**Movable pulley**

$$ T = \\frac w2 $$
"""

RESONANCE = """## Acoustic resonance

| Single open | Double open |
|---|---|
| $$f = \\frac v\\lambda = \\frac{nv}{4L}$$ | $$f = \\frac v\\lambda = \\frac{nv}{2L}$$ |
| $$\\lambda = \\frac{4L}{n}$$ | $$\\lambda = \\frac{2L}{n}$$ |
"""

THROWS = """What falls freely has passed

$$ y = \\frac{1}{2} g t^2 $$

In a throw from the ground

$$ 8 y = g t^2 $$

$$ s = 2 y = \\frac14 g t^2 $$
"""

WAVES = """## Offset

$$ y_1 = a\\sin(k x - \\omega t + \\phi_1) $$

## Standing wave

$$ y_2 = a\\sin(k x + \\omega t + \\phi_2) $$
"""

VECTORS = """$$ F = F_x + F_y $$

$$ F^2 = F_x^2 + F_y^2 $$
"""


@pytest.mark.parametrize("text", [PULLEYS, RESONANCE, WAVES, VECTORS])
def test_another_case_is_no_misprint(tmp_path, text):
    assert not {"misprint", "wrong"} & {row["verdict"] for row in judged(tmp_path, text, "text.md")}


def test_what_the_equation_in_front_gives_is_told_of_it(tmp_path):
    row = judged(tmp_path, THROWS, "text.md")[-1]
    assert (row["verdict"], row["note"]) == ("exact", "follows from (line 7)")
    slip = judged(tmp_path, THROWS.replace("8 y = ", "y + h = "), "text.md")[-1]
    assert slip["verdict"] == "misprint"


def test_a_number_behind_a_dash_is_that_of_the_equation(tmp_path):
    text = "$$ d = 2 r \\qquad-(6) $$\n\n$$ A = \\pi d^2/4 = \\pi r^2 \\qquad - (7) $$"
    rows = judged(tmp_path, text, "text.md")
    assert [row["equation"] for row in rows] == ["6", "7"]
    assert rows[-1]["verdict"] in ("exact", "definition")


def test_a_unit_in_brackets_is_no_letter(tmp_path):
    text = "The effective tire radius (m) is given.\n\n- $a$ = acceleration (m/s^2)\n- $F$ = force (N)\n\n"
    text += "$$ a = \\frac{F}{m} $$"
    assert judged(tmp_path, text, "text.md")[-1]["verdict"] != "wrong"
    module = text.replace("effective tire radius (m)", "module (m)")
    assert judged(tmp_path, module, "text.md")[-1]["verdict"] == "wrong"


def test_an_areal_mass_is_no_mass(tmp_path):
    text = "| $\\rho$ | density | kg/m^3 |\n|---|---|---|\n| $t$ | wall thickness | m |\n\n"
    text += "The areal mass is\n$$ \\mu = \\rho t $$"
    assert judged(tmp_path, text, "text.md")[-1]["verdict"] != "wrong"
    assert judged(tmp_path, text.replace("areal mass", "mass"), "text.md")[-1]["verdict"] == "wrong"
