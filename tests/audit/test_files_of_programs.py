"""Which files of a folder are read, and what is told of those that are alike."""

from audited import NONE, rows_of

from mechsym.audit.hosts.repository import audited, programs

PLACE = """def place(crank_radius, rod_length, theta):
    s = crank_radius*np.cos(theta) + np.sqrt(rod_length**2 {sign} (crank_radius*np.sin(theta))**2)
    return s
"""


def test_a_text_in_several_folders_is_told_in_each(tmp_path):
    text = PLACE.replace("{sign}", "+")
    rows = rows_of(tmp_path, {"one.py": text, "other.py": text, "third.py": text.replace("+ (", "- (")})
    assert [row["file"] for row in rows] == ["one.py", "other.py"]
    assert len({row["fingerprint"] for row in rows}) == 2


def test_what_a_tool_has_squeezed_is_not_read(tmp_path):
    long = "function f(a,b){return a*b+a/b}" * 20
    (tmp_path / "all.min.js").write_text(long)
    (file,) = audited(tmp_path, NONE, programs(tmp_path))
    assert "so a tool has made it" in file.why and file.formulas == 0
