"""The service behind a real hub, with real requests and files; only the worker in the sandbox is replaced."""

from __future__ import annotations

import http.cookiejar
import json
import re
import urllib.parse
import urllib.request
from pathlib import Path

import pytest

from autograder.notebook import handing_in
from autograder.notebook.handing_in import HandInError
from autograder.report.export import load
from tests.answers import zipped
from tests.unit.serve import serving
from tests.unit.serve.classroom import PREFIX, Classroom, ask, call_in_parallel

KEY = "0123456789abcdef" * 2
MANIFEST = "src/package/package.xml"
SETTINGS = """
instructors: [grace]
assignments:
  02_nodes: {tries_a_day: 2, due: 2030-01-01 12:00, shown: SHOWN, extensions: {late: 2001-01-01 12:00}}
  01_package_structure:
"""


def answer(text: str = "ada") -> bytes:
    return zipped({MANIFEST: text.encode()})


def start_service(classroom: Classroom, shown: str = "everything") -> Classroom:
    classroom.settings = SETTINGS.replace("SHOWN", shown)
    classroom.start()
    classroom.wait(classroom.listens)
    return classroom


def test_an_answer_is_graded_and_its_student_alone_and_instructors_see_its_page(classroom: Classroom) -> None:
    start_service(classroom)
    receipt = classroom.hand_in("ada", answer())
    assert receipt.page == f"{PREFIX}feedback/{receipt.number}"
    classroom.wait_for_marks(1)
    status, page = classroom.get("ada", f"feedback/{receipt.number}")
    assert status == 200
    assert "<h1>ada</h1>" in page
    assert "of 53 points" in page
    assert classroom.get("grace", f"feedback/{receipt.number}") == (200, page)
    status, refusal = classroom.get("bob", f"feedback/{receipt.number}")
    assert status == 403
    assert "another student" in refusal
    assert "53" not in refusal
    assert "ada" not in classroom.get("bob")[1]
    assert "53 of 53" in classroom.get("ada")[1]
    assert classroom.get("ada", "feedback/999")[0] == 404


def test_the_class_and_its_results_are_for_instructors(classroom: Classroom, tmp_path: Path) -> None:
    start_service(classroom)
    for student in ("ada", "bob"):
        classroom.hand_in(student, answer(student))
    classroom.wait_for_marks(2)
    for path in ("class/02_nodes", "class/02_nodes/results.json"):
        assert classroom.get("ada", path)[0] == 403
    file = tmp_path / "results.json"
    file.write_text(json.dumps(classroom.results()))
    assert {(result.student, result.score) for result in load(file)} == {("ada", 53.0), ("bob", 53.0)}
    assert classroom.get("grace", "class/03_interfaces")[0] == 404
    assert classroom.get("grace", "elsewhere")[0] == 404


@pytest.mark.parametrize(
    ("shown", "visible", "hidden"),
    [
        ("points", "53 of 53", "The node"),
        ("nothing", "Received and graded", "53"),
    ],
)
def test_before_the_due_time_a_student_sees_only_what_the_settings_allow(
    classroom: Classroom, shown: str, visible: str, hidden: str
) -> None:
    start_service(classroom, shown)
    number = classroom.hand_in("ada", answer()).number
    classroom.wait_for_marks(1)
    page = classroom.get("ada", f"feedback/{number}")[1]
    assert visible in page
    assert hidden not in page
    assert ("53 of 53" in classroom.get("ada")[1]) == (shown == "points")
    assert "of 53 points" in classroom.get("grace", f"feedback/{number}")[1]
    assert "53 of 53" in classroom.get("grace", "class/02_nodes")[1]
    classroom.kill()
    classroom.settings = classroom.settings.replace("2030", "2002")
    classroom.start()
    classroom.wait(classroom.listens)
    assert "of 53 points" in classroom.get("ada", f"feedback/{number}")[1]  # it is due now


def test_an_invalid_hand_in_is_refused_with_a_reason_and_costs_no_try(classroom: Classroom) -> None:
    start_service(classroom)
    for student, assignment, data, sentence in (
        ("late", "02_nodes", answer(), "02_nodes was due at 2001-01-01 12:00. Ask your instructor."),
        ("ada", "09_assessment", answer(), "This assignment does not exist here."),
        ("ada", "02_nodes", b"", "The answer is empty."),
    ):
        with pytest.raises(HandInError, match=sentence):
            classroom.hand_in(student, data, assignment=assignment)
    url, token = f"{classroom.url}hand-ins/02_nodes/{KEY}", classroom.hub.token("ada")
    assert ask(url, "", "PUT", answer())[0] == 403
    assert ask(url, "f" * 32, "PUT", answer())[0] == 403
    assert ask(f"{classroom.url}hand-ins/02_nodes/..%2f..%2fkey", token, "PUT", answer())[0] == 404
    assert [classroom.hand_in("ada", answer()).tries_left for _ in range(2)] == [1, 0]
    with pytest.raises(HandInError, match=r"You have handed in 2 times today\. Hand in again tomorrow\."):
        classroom.hand_in("ada", answer())
    classroom.wait_for_marks(1)  # a row for each student


def test_an_answer_that_is_too_large_is_refused_before_all_of_it_is_read(
    classroom: Classroom, monkeypatch: pytest.MonkeyPatch
) -> None:
    start_service(classroom)
    chunks = iter(bytes(2**20) for _ in range(100))  # without a length
    url = f"{classroom.url}hand-ins/02_nodes/{KEY}"
    headers = {"Authorization": f"token {classroom.hub.token('ada')}"}
    with pytest.raises(OSError):  # noqa: PT011
        urllib.request.urlopen(urllib.request.Request(url, chunks, headers, method="PUT"))
    assert len(list(chunks)) > 50
    monkeypatch.setattr(handing_in, "PAUSES", ())
    with pytest.raises(HandInError):
        classroom.hand_in("ada", bytes(handing_in.MAX_ANSWER + 1))
    assert "No submissions yet" in classroom.get("ada")[1]


def test_a_repeated_key_is_the_same_hand_in(classroom: Classroom) -> None:
    start_service(classroom)
    assert {classroom.hand_in("ada", answer(), KEY).number for _ in range(3)} == {1}
    assert classroom.hand_in("bob", answer(), KEY).number == 2  # keys are a student's own
    with pytest.raises(HandInError, match="Another hand-in has this key"):
        classroom.hand_in("ada", answer(), KEY, "01_package_structure")


def test_students_take_turns_however_much_one_of_them_hands_in(classroom: Classroom) -> None:
    classroom.start(hold=True)
    for student in ("ada",) * 4 + ("bob",) * 2 + ("cleo",):
        classroom.hand_in(student, answer(student))
    assert "waits: 6 before it" in classroom.get("ada")[1]
    assert "waits: 2 before it" in classroom.get("cleo")[1]
    (classroom.folder / serving.HOLD).touch()
    order = classroom.folder / serving.ORDER
    classroom.wait(lambda: order.exists() and len(order.read_text().split()) == 7)
    assert order.read_text().split() == ["ada", "bob", "cleo", "ada", "bob", "ada", "ada"]


def log_in(classroom: Classroom, user: str) -> tuple[urllib.request.OpenerDirector, str]:
    """Log a user in by the hub's form; return the browser, and the page to which it is sent back."""
    jar = http.cookiejar.CookieJar()
    browser = urllib.request.build_opener(urllib.request.HTTPCookieProcessor(jar))
    with browser.open(classroom.url) as reply:
        assert urllib.parse.urlsplit(reply.url).path == "/hub/login"
        login = reply.url
    secret = next(cookie.value for cookie in jar if cookie.name == "_xsrf" and cookie.path == "/hub/")
    form = urllib.parse.urlencode({"username": user, "password": "", "_xsrf": secret}).encode()
    with browser.open(login, form) as reply:
        assert reply.url.startswith(classroom.url)
        return browser, reply.read().decode()


def test_a_browser_is_sent_to_the_login_of_the_hub_and_back(classroom: Classroom) -> None:
    start_service(classroom)
    classroom.hand_in("ada", answer())
    browser, page = log_in(classroom, "ada")
    assert "<h1>Submissions</h1>" in page
    with pytest.raises(urllib.error.HTTPError, match="403"):  # a cookie does not authorise a hand-in
        browser.open(urllib.request.Request(f"{classroom.url}hand-ins/02_nodes/{KEY}", answer(), method="PUT"))


def test_an_instructor_can_have_a_class_graded_again(classroom: Classroom) -> None:
    start_service(classroom)
    order = classroom.folder / serving.ORDER
    for student in ("ada", "bob"):
        classroom.hand_in(student, answer(student))
    classroom.wait_for_marks(2)
    address = f"{classroom.url}class/02_nodes"
    assert ask(f"{address}/regrade", classroom.hub.token("ada"), "POST", b"")[0] == 403
    browser, _ = log_in(classroom, "grace")
    with pytest.raises(urllib.error.HTTPError, match="403"):  # a form of another page
        browser.open(f"{address}/regrade", b"")
    assert len(order.read_text().split()) == 2
    with browser.open(address) as reply:
        (field,) = re.findall(r'<input type="hidden" name="_xsrf" value="([^"]*)"', reply.read().decode())
    with browser.open(f"{address}/regrade", urllib.parse.urlencode({"_xsrf": field}).encode()) as reply:
        assert reply.url == address
    classroom.wait(lambda: len(order.read_text().split()) == 4)
    classroom.wait_for_marks(2)
    assert sorted(order.read_text().split()) == ["ada", "ada", "bob", "bob"]


def hand_in_at_once(classroom: Classroom, students: int) -> None:
    names = [f"student{number:03}" for number in range(students)]
    for name in names:
        classroom.hub.token(name)
    receipts = call_in_parallel([lambda name=name: classroom.hand_in(name, answer(name)) for name in names])  # type: ignore[misc]
    assert sorted(receipt.number for receipt in receipts) == list(range(1, students + 1))
    classroom.wait_for_marks(students)
    assert {(row["student"], row["score"]) for row in classroom.results()} == {(name, 53.0) for name in names}


@pytest.mark.slow
def test_twenty_students_at_once_have_twenty_marks(classroom: Classroom) -> None:
    classroom.start(jobs=2)
    hand_in_at_once(classroom, 20)


@pytest.mark.nightly
def test_two_hundred_students_at_once_have_two_hundred_marks(classroom: Classroom) -> None:
    classroom.start(jobs=2)
    hand_in_at_once(classroom, 200)
