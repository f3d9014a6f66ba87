"""A case from an upload names nothing that is read: files, mechanisms, tables and other people's cases are refused."""

import pytest

from mechsym import cases
from mechsym.app import safe
from mechsym.app.uploads import LARGEST, harmless, keep, kept
from mechsym.errors import BadInput

TEXT = cases.text("zotov-89")


@pytest.mark.parametrize("name", [name for name in cases.names() if name != "generator"])
def test_built_in_cases_are_harmless(name):
    text = cases.text(name)
    assert harmless(text.encode()) == text


@pytest.mark.parametrize(
    ("old", "new", "said"),
    [
        ('mechanism = "crosshead"', 'mechanism = "./own.py"', "is not built in"),
        ('mechanism = "crosshead"', 'mechanism = "/tmp/own.py:X"', "is not built in"),
        ('mechanism = "crosshead"', 'mechanism = ["crosshead"]', "is not built in"),
        ('curve = "propeller"', 'curve = "points.csv"', "codesign.curve"),
        ('high_case = "zotov-142"', 'high_case = "/etc/passwd"', "codesign.high_case"),
        ('high_case = "zotov-142"', 'high_case = "./theirs.toml"', "codesign.high_case"),
        ("[codesign]", '[sizing]\nmaterials_file = "/etc/passwd"\n[codesign]', "sizing.materials_file"),
        ("[codesign]", '[sizing]\nsettings = ["cycle.file=/etc/passwd"]\n[codesign]', "sizing.settings"),
        ("[codesign]", '[sizing]\nsettings = ["file=/etc/passwd"]\n[codesign]', "sizing.settings"),
        ("[codesign]", '[sizing]\nrival = "../theirs.toml"\n[codesign]', "sizing.rival"),
        ("[codesign]", '[audit]\ntheory = "theory.toml"\n[codesign]', "audit.theory"),
        ('case = "zotov-142"', 'case = "other.toml"', "retune.case"),
    ],
)
def test_what_would_be_read_is_refused(old, new, said):
    assert old in TEXT
    with pytest.raises(BadInput, match=said):
        harmless(TEXT.replace(old, new).encode())


@pytest.mark.parametrize("data", [b"\xff\xfe", b"mechanism = ", b"x" * (LARGEST + 1), b"", b"a = 1"])
def test_what_is_no_case_is_a_sentence(data):
    with pytest.raises(BadInput) as refused:
        keep(data)
    assert "\n" not in str(refused.value)


def test_a_measured_diagram_is_a_file_and_refused():
    with pytest.raises(BadInput, match="cycle.file"):
        harmless(cases.text("generator").encode())


def test_an_upload_is_known_by_a_name_that_cannot_be_guessed():
    name, other = keep(TEXT.encode()), keep(TEXT.encode())
    assert name != other and kept(name) != kept(other) and kept("upload-0000000000000000") is None
    assert safe(name, "zotov-89", {"spring.p0": "6e6"}) == {"spring.p0": 6e6}
    with pytest.raises(BadInput, match="not built in"):
        safe("upload-0000000000000000", "zotov-89", {})
    path = kept(name)
    assert path is not None
    assert cases.load(path).sections["spring"].p0 == cases.load("zotov-89").sections["spring"].p0


def test_a_case_with_a_fault_is_refused_without_its_place_on_this_machine():
    with pytest.raises(BadInput) as refused:
        keep(TEXT.replace('A = "0.031 m^2"', 'A = "-1 m^2"').encode())
    assert "/tmp" not in str(refused.value) and "the upload" in str(refused.value)
