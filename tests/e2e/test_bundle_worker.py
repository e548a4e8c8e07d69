"""What a package of messages installs comes back from the worker that builds it, or is refused with a sentence."""

from __future__ import annotations

from multiprocessing import Pipe
from pathlib import Path
from threading import Thread

import pytest

from autograder.building import keeper
from autograder.exceptions import StudentError
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.trees import read_tree
from tests.e2e.test_build_outcomes import write_messages

UNREADABLE = """import os, sys
os.close(os.open(sys.argv[1] + '/secret', os.O_CREAT, 0))
"""
LONG = """import os, sys
os.chdir(sys.argv[1])
for _ in range(20):
    os.mkdir('n' * 200)
    os.chdir('n' * 200)
"""
ODD = r"""import os, sys
top = sys.argv[1]
os.symlink(top + '/share/package.xml', top + '/share/manifest.xml')
for number in range(4500):
    open(os.fsencode(top) + b'/' + b'\xff' * 200 + b'%d' % number, 'w').close()
os.makedirs(top + '/d' * 31)
"""


def built(folder: Path, fills: str) -> Path:
    """Have a package built by a worker in a cell, as a grading asks for it; return what comes back."""
    write_messages(folder / "sources" / "words", fills)
    ours, theirs = Pipe()
    with ours, theirs:
        sources = read_tree(folder / "sources", SOURCES)
        serving = Thread(target=keeper.attend, args=(ours, Isolation.BUBBLEWRAP, lambda: True))
        serving.start()
        try:
            keeper.ask(theirs, sources, folder / "made")
        finally:
            theirs.close()
            serving.join()
    return folder / "made" / "install" / "words"


@pytest.mark.parametrize(
    ("fills", "told"),
    [(UNREADABLE, "words/secret, which cannot be read (Permission denied)"), (LONG, "has more than 1024 bytes")],
)
def test_a_build_that_cannot_be_stored_is_a_failed_build_with_a_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, fills: str, told: str
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    with pytest.raises(StudentError) as caught:
        built(tmp_path, fills)
    assert told in caught.value.diagnosis.sentence


def test_links_within_it_odd_names_and_deep_folders_are_kept_as_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))
    made = built(tmp_path, ODD)
    assert (made / "share" / "manifest.xml").readlink() == Path("package.xml")
    assert len(list(made.glob("\udcff*"))) == 4500
    assert (made / "/".join("d" * 31)).is_dir()
