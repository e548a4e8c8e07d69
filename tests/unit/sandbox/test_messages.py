"""A tree that is received over a worker's line matches its list, or is refused."""

from __future__ import annotations

import json
from dataclasses import astuple
from multiprocessing import Pipe
from pathlib import Path

import pytest

from autograder.building import bundle_server
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.messages import MessageError, receive_message, receive_tree, send_tree, write_received
from autograder.run.sandbox.trees import Entry, TreeError, list_tree, read_tree

FOLDER = Entry("p", "folder")


def send_and_receive(tree: dict[Entry, bytes]) -> dict[Entry, bytes]:
    ours, theirs = Pipe()
    with ours, theirs:
        send_tree(theirs, tree)
        theirs.close()
        return receive_tree(ours, SOURCES)


def test_a_file_has_the_size_that_the_list_says() -> None:
    with pytest.raises(MessageError, match="more than 1 bytes"):
        send_and_receive({Entry("a", "file", False, 1): b"more"})
    with pytest.raises(MessageError, match="a file of 9 bytes has 4"):
        send_and_receive({Entry("a", "file", False, 9): b"less"})


def test_a_sender_that_ends_without_reading_has_closed_the_connection() -> None:
    ours, theirs = Pipe()
    with ours:
        ours.send_bytes(b"unread")
        theirs.close()
        with pytest.raises(EOFError):
            receive_message(ours)


def test_different_trees_have_different_keys() -> None:
    first, second = Entry("a.msg", "file", False, 1), Entry("b.msg", "file", False, 2)
    joined = b"x" + json.dumps(astuple(second)).encode() + b"yz"
    assert bundle_server.key({first: b"x", second: b"yz"}) != bundle_server.key({first: joined})


@pytest.mark.parametrize(
    "entries",
    [
        [Entry("p", "link", size=4), Entry("p/etc", "link", size=4)],
        [Entry("p/a", "file")],
        [FOLDER, FOLDER],
        [FOLDER, Entry("p", "file")],
        [Entry("../a", "file")],
        [Entry("\ud800", "file")],
        [Entry("n" * 1025, "file")],
    ],
)
def test_a_path_only_leads_through_folders_of_the_tree(entries: list[Entry]) -> None:
    ours, theirs = Pipe()
    with ours, theirs:
        theirs.send_bytes(json.dumps([astuple(entry) for entry in entries]).encode())
        theirs.close()
        with pytest.raises(MessageError):
            receive_tree(ours, SOURCES)


def test_a_list_with_an_infinite_size_is_refused() -> None:
    ours, theirs = Pipe()
    with ours, theirs:
        theirs.send_bytes(b'[["a", "file", false, Infinity]]')
        with pytest.raises(MessageError):
            receive_tree(ours, SOURCES)


def test_existing_files_are_neither_overwritten_nor_followed(tmp_path: Path) -> None:
    (tmp_path / "outside").mkdir()
    (tmp_path / "root").mkdir()
    (tmp_path / "root" / "p").symlink_to("../outside")
    with pytest.raises(FileExistsError):
        write_received({FOLDER: b"", Entry("p/a", "file", size=1): b"x"}, tmp_path / "root")
    with pytest.raises(FileExistsError):
        write_received({Entry("p", "file", size=1): b"x"}, tmp_path / "root")
    assert not list((tmp_path / "outside").iterdir())


def test_an_absolute_link_within_a_tree_is_relative_in_its_copy(tmp_path: Path) -> None:
    source = tmp_path / "source"
    (source / "p").mkdir(parents=True)
    (source / "p" / "link").symlink_to(source / "file")
    (source / "file").write_text("there")
    write_received(send_and_receive(read_tree(source, SOURCES)), tmp_path / "copy")
    assert (tmp_path / "copy" / "p" / "link").readlink() == Path("../file")


def test_the_paths_of_a_tree_are_bounded_before_they_are_sent(tmp_path: Path) -> None:
    folder = tmp_path / "/".join("n" * 200 for _ in range(6))
    folder.mkdir(parents=True)
    with pytest.raises(TreeError, match="more than 1024 bytes"):
        list_tree(tmp_path, SOURCES)
