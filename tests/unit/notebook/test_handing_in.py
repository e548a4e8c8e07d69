"""Handing in from a notebook: the answer that is sent, and the receipt or notice that is shown."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path, PurePosixPath

import pytest

from autograder.exceptions import UsageError
from autograder.notebook import handing_in, submit
from autograder.notebook.handing_in import SERVICE, TOKEN, HandInError, Receipt, hand_in, make_zip
from autograder.notebook.notices import Notice
from autograder.submission.intake import SubmittedFile, read_files

CHAPTER = "02_nodes"
NOWHERE = "http://127.0.0.1:9/services/autograder/"  # a port on which nothing listens


@pytest.fixture
def answer(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder with an answer, on a hub whose service does not run."""
    monkeypatch.setenv(SERVICE, NOWHERE)
    monkeypatch.setenv(TOKEN, "token")
    monkeypatch.setattr(handing_in, "PAUSES", ())
    package = tmp_path / "ws" / "src" / "my_robot_package"
    package.mkdir(parents=True)
    (package / "package.xml").write_text("<package/>")
    return tmp_path


def test_without_a_hub_a_notice_says_so(answer: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(SERVICE)
    notice = submit(CHAPTER, answer)
    assert isinstance(notice, Notice)
    assert "This hub does not grade submissions" in notice.sentence


def test_an_assignment_that_does_not_exist_is_named() -> None:
    with pytest.raises(UsageError, match="'02_node' is not an assignment to hand in"):
        submit("02_node")


def test_a_folder_without_an_answer_is_named_before_anything_is_sent(answer: Path, tmp_path: Path) -> None:
    (tmp_path / "empty").mkdir()
    notice = submit(CHAPTER, tmp_path / "empty")
    assert isinstance(notice, Notice)
    assert notice.sentence == "Nothing was handed in."
    assert notice.detail


def test_an_answer_that_is_too_large_is_not_sent(answer: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(handing_in, "MAX_ANSWER", 10)
    notice = submit(CHAPTER, answer)
    assert isinstance(notice, Notice)
    assert "Move large files" in notice.detail


def test_without_a_reply_the_same_answer_keeps_its_key(answer: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    keys: list[str] = []

    def record_key(service: str, token: str, assignment: str, key: str, data: bytes) -> Receipt:
        keys.append(key)
        return hand_in(service, token, assignment, key, data)

    monkeypatch.setattr(handing_in, "hand_in", record_key)
    for _ in range(2):
        notice = submit(CHAPTER, answer)
        assert isinstance(notice, Notice)
        assert notice.sentence == handing_in.UNSURE
        assert "The service does not answer" in notice.detail
    (answer / "ws" / "src" / "my_robot_package" / "more.txt").write_text("more")
    submit(CHAPTER, answer)
    assert keys[0] == keys[1] != keys[2]


def test_equal_files_make_equal_zips_and_keep_their_modes() -> None:
    files = [
        SubmittedFile(PurePosixPath("ws/src/b"), b"b", True),
        SubmittedFile(PurePosixPath("ws/src/a"), b"a", False),
    ]
    assert make_zip(files) == make_zip(files[::-1])
    with zipfile.ZipFile(io.BytesIO(make_zip(files))) as archive:
        assert archive.namelist() == ["ws/src/a", "ws/src/b"]
        assert [info.external_attr >> 16 for info in archive.infolist()] == [0o100644, 0o100755]


def test_a_packed_answer_is_read_like_its_folder(answer: Path, tmp_path: Path) -> None:
    files = read_files(answer, CHAPTER)
    (tmp_path / "answer.zip").write_bytes(make_zip(files))
    assert sorted(read_files(tmp_path / "answer.zip", CHAPTER), key=str) == sorted(files, key=str)


def test_a_receipt_says_what_comes_next() -> None:
    receipt = handing_in._receipt(
        CHAPTER, b'{"number": 7, "handed_in": "2026-10-05T12:00:00+00:00", "tries_left": 1, "page": "/a?<b>"}'
    )
    assert "is handed in as number 7" in repr(receipt)
    assert "You have 1 more try today." in repr(receipt)
    assert 'href="/a?&lt;b&gt;"' in receipt._repr_html_()


@pytest.mark.parametrize("reply", [b"<html>", b"[]", b'{"number": "x"}', b'{"number": 1, "handed_in": 5}'])
def test_a_reply_of_another_program_is_not_a_receipt(reply: bytes) -> None:
    with pytest.raises(HandInError, match="The reply is not from the grading service"):
        handing_in._receipt(CHAPTER, reply)
