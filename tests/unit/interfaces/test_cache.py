"""The cache of built trees: whole entries only, built once, kept while in use, bounded."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.building.interfaces.cache import Cache

A, B, C = "a" * 40, "b" * 40, "c" * 40

WORKER = """
import sys
from pathlib import Path
from autograder.building.interfaces.cache import Cache

root, log, after = Path(sys.argv[1]), sys.argv[2], sys.argv[3]

def make(folder):
    (folder / "half").write_text("x")
    with open(log, "a") as file:
        file.write("made\\n")
    print("making", flush=True)
    if after == "wait":
        sys.stdin.readline()
    (folder / "whole").write_text("x")

entry = Cache(root).get("a" * 40, make)
assert (entry / "whole").is_file()
print("got", flush=True)
sys.stdin.readline()
"""


def start(cache: Path, log: Path, after: str = "") -> subprocess.Popen[str]:
    return subprocess.Popen(
        [sys.executable, "-c", WORKER, str(cache), str(log), after],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )


def read_line(process: subprocess.Popen[str]) -> str:
    assert process.stdout is not None
    return process.stdout.readline().strip()


def send_line(process: subprocess.Popen[str]) -> None:
    assert process.stdin is not None
    process.stdin.write("\n")
    process.stdin.flush()


def fill(folder: Path) -> None:
    (folder / "file").write_bytes(b"x" * 1000)


def test_two_processes_that_need_the_same_entry_build_it_once(tmp_path: Path) -> None:
    log = tmp_path / "log"
    with start(tmp_path / "cache", log, "wait") as first:
        assert read_line(first) == "making"
        with start(tmp_path / "cache", log) as second:
            send_line(first)
            assert [read_line(first), read_line(second)] == ["got", "got"]
            assert log.read_text() == "made\n"
            send_line(first)
            send_line(second)
    assert (first.returncode, second.returncode) == (0, 0)


def test_a_killed_build_leaves_no_entry_and_the_next_one_makes_it(tmp_path: Path) -> None:
    with start(tmp_path / "cache", tmp_path / "log", "wait") as process:
        assert read_line(process) == "making"
        process.send_signal(signal.SIGKILL)
    assert not (tmp_path / "cache" / A).exists()
    entry = Cache(tmp_path / "cache").get(A, lambda folder: (folder / "whole").touch())
    assert [path.name for path in entry.iterdir()] == ["whole"]


def test_files_that_a_killed_build_left_are_removed_later(tmp_path: Path) -> None:
    leftover = tmp_path / ".aaaa-left"
    leftover.mkdir()
    os.utime(leftover, (0, 0))
    Cache(tmp_path).get(A, lambda folder: None)
    assert not leftover.exists()


def test_a_build_that_fails_leaves_nothing(tmp_path: Path) -> None:
    def fail(folder: Path) -> None:
        (folder / "half").touch()
        raise ValueError("no")

    with pytest.raises(ValueError, match="no"):
        Cache(tmp_path).get(A, fail)
    assert [path.name for path in tmp_path.iterdir()] == [f"{A}.lock"]


def test_the_entry_unused_for_longest_goes_first(tmp_path: Path) -> None:
    cache = Cache(tmp_path)
    for used, key in ((2, A), (1, B)):
        os.utime(cache.get(key, fill), (used, used))
    Cache(tmp_path, limit=2500).get(C, fill)
    assert [(tmp_path / key).is_dir() for key in (A, B, C)] == [True, False, True]


def test_the_limit_on_entries_holds_even_if_many_are_created_at_once(tmp_path: Path) -> None:
    cache = Cache(tmp_path, limit=2500)
    for number in range(20):
        cache.get(f"{number:040x}", fill)
    assert len(list(tmp_path.rglob("file"))) == 2


def test_large_entries_replace_each_other_and_not_small_ones(tmp_path: Path) -> None:
    def fill_much(folder: Path) -> None:
        (folder / "file").write_bytes(b"x" * 12_000)

    cache = Cache(tmp_path, limit=32_000)
    for used, key in enumerate((A, B, C)):
        os.utime(cache.get(key, fill), (used, used))
    for number in range(8):
        cache.get(f"{number:040x}", fill_much)
    sizes = [path.stat().st_size for path in tmp_path.rglob("file")]
    assert sorted(sizes) == [1000] * 3 + [12_000] * 2


def test_an_entry_is_evicted_only_when_no_longer_in_use(tmp_path: Path) -> None:
    cache = Cache(tmp_path, limit=1)
    with cache.use(A, fill) as entry, cache.use(A, fill) as same_entry:
        cache.get(B, fill)
        assert (entry / "file").is_file()
        assert same_entry == entry
    cache.get(C, fill)
    assert not (tmp_path / A).exists()


def test_the_default_cache_is_in_the_users_cache_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    assert Cache.default("things").root == tmp_path / "autograder" / "things"


def test_a_cache_folder_that_cannot_be_made_is_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "file").touch()
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "file"))
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path / "temporary"))
    assert Cache.default("things").root.is_relative_to(tmp_path / "temporary")
