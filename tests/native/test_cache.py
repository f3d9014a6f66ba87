"""Compiled files: found again, rebuilt when damaged, made by several processes at once, done without."""

import hashlib
import os
import shutil
import stat
import subprocess
import sys
from pathlib import Path

import casadi as ca
import pytest

from mechsym import native, transaction
from mechsym.native import cache, compiler
from mechsym.native.compiler import NoCompiler

needs_compiler = pytest.mark.skipif(not any(map(shutil.which, ("gcc", "clang", "cc"))), reason="no C compiler")
SOURCE = '__attribute__((visibility("default"))) int answer(void)\n{\n    return 42;\n}\n'
SCRIPT = """
import casadi as ca
from mechsym import native
x = ca.SX.sym("x")
f = ca.Function("square_root", [x], [ca.sqrt(x)])
made = native.compiled(f)
print(made.route, made.scalar(16.0), made.batch([4.0, 9.0]).tolist(), made.reason)
"""


@pytest.fixture(autouse=True)
def home(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "mechsym" / "native"


def sound(folder: Path) -> list[Path]:
    """Shared objects whose name tells the checksum of their bytes."""
    files = list(folder.glob("*/*.so"))
    return [f for f in files if hashlib.sha256(f.read_bytes()).hexdigest().startswith(f.stem.split("-")[1])]


@needs_compiler
def test_second_call_takes_the_file_of_the_first(monkeypatch):
    first = cache.shared_object(SOURCE, "strict")
    monkeypatch.setattr(compiler, "compile_file", lambda *_: pytest.fail("compiled again"))
    assert cache.shared_object(SOURCE, "strict") == first
    assert cache.shared_object.__module__ == "mechsym.native.cache"


@needs_compiler
@pytest.mark.parametrize("damage", ["truncated", "changed", "empty"])
def test_damaged_file_is_made_again(home, damage):
    path = cache.shared_object(SOURCE, "strict")
    content = path.read_bytes()
    middle = len(content) // 2
    broken = {
        "truncated": content[:middle],
        "changed": content[:middle] + bytes([content[middle] ^ 1]) + content[middle + 1 :],
        "empty": b"",
    }
    path.write_bytes(broken[damage])
    again = cache.shared_object(SOURCE, "strict")
    assert sound(home) == [again]
    assert cache.load(SOURCE, "strict").answer() == 42


@needs_compiler
def test_a_folder_that_a_process_could_not_remove_goes_with_the_next(home):
    made = cache.shared_object(SOURCE, "strict")
    ended = subprocess.Popen([sys.executable, "-c", ""])
    ended.wait()
    left = made.parent / f".build.{transaction._machine()}-{ended.pid}-0123abcd"
    left.mkdir()
    (left / "half.c").write_text("half")
    assert cache.shared_object(SOURCE, "strict") == made
    assert not left.exists()


@needs_compiler
def test_key_depends_on_all_that_decides_the_contents(monkeypatch):
    keys = {cache.key(SOURCE, compiler.flags(mode), "a") for mode in compiler.MODES}
    keys |= {cache.key(SOURCE + " ", compiler.flags("fast"), "a"), cache.key(SOURCE, compiler.flags("fast"), "b")}
    monkeypatch.setattr(compiler, "processor", lambda: "another")
    keys.add(cache.key(SOURCE, compiler.flags("fast"), "a"))
    assert len(keys) == 5


@needs_compiler
def test_processes_that_compile_at_once(home):
    runs = [subprocess.Popen([sys.executable, "-c", SCRIPT], stdout=subprocess.PIPE, text=True) for _ in range(4)]
    printed = {run.communicate(timeout=120)[0].strip() for run in runs}
    assert printed == {"C 4.0 [[2.0, 3.0]]"}
    assert len(sound(home)) == len(list(home.glob("*/*.so"))) >= 1
    assert not list(home.glob("**/build-*"))


def test_without_a_compiler_in_the_path(tmp_path):
    environment = {k: v for k, v in os.environ.items() if k != "CC"} | {"PATH": str(tmp_path)}
    done = subprocess.run([sys.executable, "-c", SCRIPT], env=environment, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("numpy 4.0 [[2.0, 3.0]]")
    assert "no C compiler found (tried gcc, clang, cc); install gcc or clang" in done.stderr


@pytest.mark.skipif(not shutil.which("false"), reason="no command that fails")
def test_compiler_that_fails_is_named(monkeypatch):
    monkeypatch.setenv("CC", "false")
    with pytest.raises(NoCompiler, match="false failed"):
        cache.shared_object(SOURCE, "strict")


BROKEN = {
    "exit 0": "made nothing",
    'for a; do [ "$before" = "-o" ] && echo text > "$a"; before="$a"; done': "made what cannot be loaded",
    "exec sleep 60": "did not end in 0.5 s",
}


@pytest.mark.skipif(os.name != "posix", reason="a compiler in the shell")
@pytest.mark.parametrize("does", BROKEN)
def test_a_compiler_that_makes_nothing_of_use_or_hangs_is_told(monkeypatch, tmp_path, home, does):
    script = tmp_path / "broken"
    script.write_text(f"#!/bin/sh\n{does}\n")
    script.chmod(0o755)
    monkeypatch.setenv("CC", str(script))
    monkeypatch.setattr(compiler, "PATIENCE", 0.5)
    for _ in range(2):  # what was made is not kept
        with pytest.raises(NoCompiler, match=BROKEN[does]):
            cache.load(SOURCE, "strict")


def test_named_compiler_that_is_missing(monkeypatch):
    monkeypatch.setenv("CC", "no-such-compiler -O2")
    with pytest.raises(NoCompiler, match="tried no-such-compiler"):
        compiler.find()


@needs_compiler
def test_cache_directory_that_cannot_be_used(monkeypatch, tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    monkeypatch.setenv("XDG_CACHE_HOME", str(file))
    assert cache.load(SOURCE, "strict").answer() == 42


@needs_compiler
def test_code_is_not_loaded_from_a_directory_that_others_write(home):
    home.mkdir(parents=True)
    home.chmod(0o777)
    assert home not in cache.shared_object(SOURCE, "strict").parents
    assert stat.S_IMODE(home.stat().st_mode) == 0o777


def test_relative_cache_directory_is_ignored(monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", "here")
    assert cache.directory().is_absolute()
    assert "here" not in cache.directory().parts


@needs_compiler
def test_clear(home):
    cache.shared_object(SOURCE, "strict")
    assert cache.clear() == 2
    assert cache.contents() == []
    assert cache.clear() == 0


@needs_compiler
def test_without_python_headers_calls_go_through_ctypes(monkeypatch):
    monkeypatch.setattr(compiler, "python_header", lambda: None)
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    made = native.compiled(ca.Function("two", [x, y], [x + y, x * y]))
    assert made.route == "C"
    assert made.scalar(2.0, 3.0) == (5.0, 6.0)
    with pytest.raises(TypeError, match="takes 2 numbers, not 1"):
        made.scalar(2.0)


@needs_compiler
def test_files_used_longest_ago_are_removed(home, monkeypatch):
    made = [cache.shared_object(SOURCE + f"/* {i} */", "strict") for i in range(4)]
    for age, path in zip((40, 10, 30, 20), made, strict=True):
        os.utime(path, (1e9 - age, 1e9 - age))
    cache.shared_object(SOURCE + "/* 0 */", "strict")  # used again
    size = sum(p.stat().st_size for p in cache.contents())
    monkeypatch.setattr(cache, "_MOST", size)
    new = cache.shared_object(SOURCE + "/* 5 */", "strict")
    left = [p for p in cache.contents() if p.suffix == ".so"]
    assert new in left and made[0] in left
    assert made[2] not in left
    assert sum(p.stat().st_size for p in cache.contents()) <= size


@needs_compiler
def test_what_cc_says_to_the_compiler_is_compiled_for(monkeypatch):
    plain = cache.shared_object(SOURCE, "strict")
    monkeypatch.setenv("CC", f"{compiler.find().command[0]} -O0")
    other = cache.shared_object(SOURCE, "strict")
    assert plain.name.partition("-")[0] != other.name.partition("-")[0]
    assert plain.read_bytes() != other.read_bytes()  # -O0, and not what comes after it
