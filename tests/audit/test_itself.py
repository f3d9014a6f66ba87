"""What programs say of themselves: slopes by their names, steps that are none, angles in degrees."""

from audited import rows_of


def test_an_angle_is_converted_once(tmp_path):
    """As in a public toolbox of gears, whose radial force is a sixtieth of what it should be."""
    text = "def forces(w, angle):\n    phi_t = radians(angle)\n    w_r = w*tan({})\n    return w_r\n"
    assert not rows_of(tmp_path / "right", {"a.py": text.format("phi_t"), "b.py": text.format("radians(angle)")})
    (row,) = rows_of(tmp_path / "wrong", {"a.py": text.format("radians(phi_t)")})
    assert (row["verdict"], row["correction"], row["line"]) == ("misprint", "w*tan(phi_t)", 3)


def test_an_angle_in_degrees_is_converted_everywhere(tmp_path):
    """As in a public program of a slider crank, one sine of whose acceleration is taken of degrees."""
    text = (
        "def crank(r, l, theta, w):\n    x = r*cos(theta*pi/180) + l\n    y = r*sin(radians(theta))\n"
        "    v = -r*w*sin({})\n    return x, y, v\n"
    )
    assert not rows_of(tmp_path / "right", {"a.py": text.format("theta*pi/180")})
    own = "def crank(r, l, theta, w):\n    x = r*cos(theta) + l\n    theta = radians(theta)\n    y = r*sin(theta)\n"
    assert not rows_of(tmp_path / "own", {"a.py": own})  # two meanings, one after the other
    (row,) = rows_of(tmp_path / "wrong", {"a.py": text.format("theta")})
    assert row["line"] == 4 and "is converted in line 2, 3" in row["note"] and "pi/180" in row["correction"]
    (row,) = rows_of(tmp_path / "sum", {"a.py": text.format("2*theta")})
    assert row["line"] == 4


def test_branches_may_count_an_angle_each_in_its_own_way(tmp_path):
    text = (
        "def crank(r, theta, degrees):\n    if degrees:\n        x = r*cos(theta*pi/180)\n"
        "        y = r*sin(theta*pi/180)\n"
        "    else:\n        x = r*cos(theta)\n    return x\n"
    )
    assert not rows_of(tmp_path, {"a.py": text})


def test_a_step_of_an_iteration_is_no_derivative(tmp_path):
    step = "def zero(a, phi):\n    x = a*phi\n    g = x**2 - 2*phi\n    dx = g/(2*x)\n    x = x - dx\n    return x\n"
    assert not rows_of(tmp_path / "step", {"newton.py": step})
    slope = "def place(a, phi):\n    dx = 3*a*phi\n    x = a*phi**2\n    return x\n"
    (row,) = rows_of(tmp_path / "slope", {"slope.py": slope})
    assert row["verdict"] == "derivative"


def test_a_one_that_was_an_l_is_told(tmp_path):
    """As in a public program of a crank drive whose rod has a length that nothing uses."""
    text = "r, l = 1.0, {}\n\n\ndef piston(theta):\n    return r*sin(theta) + sqrt({}**2 - (r*cos(theta))**2)\n"
    (row,) = rows_of(tmp_path / "wrong", {"a.py": text.format("4.0", 1)})
    assert (row["verdict"], row["correction"]) == ("misprint", "r*sin(theta) + sqrt(l**2 - (r*cos(theta))**2)")
    assert not rows_of(tmp_path / "right", {"a.py": text.format("4.0", "l"), "b.py": text.format("1.0", 1)})
    assert not rows_of(tmp_path / "other", {"a.py": text.replace("l =", "m =").format("4.0", 1)})
