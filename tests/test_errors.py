"""What a reader of an error has to know stands beside its words, also behind the border of a process."""

import pickle

import pytest

from mechsym import cases
from mechsym.cases.check import check_file
from mechsym.errors import BadInput
from mechsym.files.inputs import read_text


def test_an_error_crosses_processes_with_what_stands_beside_its_words():
    error = pickle.loads(pickle.dumps(BadInput("it is wrong", "mend it", key="a.b", reason="why")))
    assert (str(error), error.why, error.way, error.key, error.reason) == (
        "it is wrong; mend it", "it is wrong", "mend it", "a.b", "why",
    )  # fmt: skip


@pytest.mark.parametrize(("content", "reason"), [
    (None, "No such file or directory"), (b"a: b (c)\xff", "not UTF-8 text (byte 8)"),
])  # fmt: skip
def test_why_a_file_cannot_be_read_is_told_once(tmp_path, content, reason):
    path = tmp_path / "a: b.toml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(BadInput) as refused:
        read_text(str(path), way_out="give another")
    assert refused.value.reason == reason
    with pytest.raises(BadInput, match="nor a readable file") as refused:
        cases.load(str(path))
    assert f"({reason}); " in str(refused.value)


def test_a_wrong_word_and_an_impossible_value_are_told_with_their_keys(tmp_path):
    text = cases.text("zotov-89")
    path = tmp_path / "mine.toml"
    path.write_text(text.replace('law = "air_absolute"', 'law = "rubber = gum; steel"'))
    (problem,) = check_file(str(path)).problems
    assert problem.key == "spring.law" and "'rubber = gum; steel' is not known" in problem.why
    assert problem.allowed.startswith("allowed are")
    path.write_text(text.replace('bore = "0.3 m"', 'bore = "5 m"'))
    assert path.read_text() != text
    (problem,) = check_file(str(path)).problems
    assert problem.key.endswith(".bore") and "possible is" in problem.why
