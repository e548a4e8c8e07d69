"""A worker that builds a message package returns the installed files, or refuses them with a sentence."""

from __future__ import annotations

from multiprocessing import Pipe
from pathlib import Path
from threading import Thread

import pytest

from autograder.building import bundle_server
from autograder.exceptions import StudentError
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.trees import read_tree
from tests.e2e.test_build_outcomes import write_messages

UNREADABLE = """import os, sys
os.close(os.open(sys.argv[1] + '/secret', os.O_CREAT, 0))
"""
LONG_PATH = """import os, sys
os.chdir(sys.argv[1])
for _ in range(20):
    os.mkdir('n' * 200)
    os.chdir('n' * 200)
"""
ODD_FILES = r"""import os, sys
top = sys.argv[1]
os.symlink(top + '/share/package.xml', top + '/share/manifest.xml')
for number in range(4500):
    open(os.fsencode(top) + b'/' + b'\xff' * 200 + b'%d' % number, 'w').close()
os.makedirs(top + '/d' * 31)
"""


def build_in_worker(folder: Path, script: str) -> Path:
    """Build a package in a worker, as a grading does; return the folder of the files that it returned."""
    write_messages(folder / "sources" / "words", script)
    ours, theirs = Pipe()
    with ours, theirs:
        sources = read_tree(folder / "sources", SOURCES)
        worker = Thread(target=bundle_server.serve_worker, args=(ours, Isolation.BUBBLEWRAP, lambda: True))
        worker.start()
        try:
            bundle_server.request_build(theirs, sources, folder / "made")
        finally:
            theirs.close()
            worker.join()
    return folder / "made" / "install" / "words"


@pytest.mark.parametrize(
    ("script", "sentence"),
    [(UNREADABLE, "words/secret, which cannot be read (Permission denied)"), (LONG_PATH, "has more than 1024 bytes")],
)
def test_a_build_whose_files_cannot_be_stored_fails_with_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, script: str, sentence: str
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    with pytest.raises(StudentError) as excinfo:
        build_in_worker(tmp_path, script)
    assert sentence in excinfo.value.diagnosis.sentence


def test_inner_links_odd_names_and_deep_folders_are_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    installed = build_in_worker(tmp_path, ODD_FILES)
    assert (installed / "share" / "manifest.xml").readlink() == Path("package.xml")
    assert len(list(installed.glob("\udcff*"))) == 4500
    assert (installed / "/".join("d" * 31)).is_dir()
