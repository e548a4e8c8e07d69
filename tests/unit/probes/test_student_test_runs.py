"""Runs of a student's tests report the outcomes for a version, and the tests cannot change the run."""

from __future__ import annotations

import errno
import itertools
import os
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.probes import student_test_runs
from autograder.probes.student_test_reports import Report, TestRun
from autograder.probes.student_test_runs import read_source, run
from autograder.probes.versions import Version
from autograder.ros import environment
from autograder.run.sandbox import ExitReason
from autograder.run.sandbox.limits import TEST_RUN

pytestmark = pytest.mark.slow  # each run is a pytest of its own

RIGHT = Version({"package.xml": "<package/>", "half/__init__.py": "def half(x):\n    return x / 2\n"}, {})
WRONG = Version({**RIGHT.files, "half/__init__.py": "def half(x):\n    return x // 2\n"}, {})
GOOD = """from half import half

def test_odd():
    assert half(3) == 1.5

def test_even():
    assert half(4) == 2
"""


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """A workspace in which a package `half` was built."""
    (tmp_path / "ws/src/half/test").mkdir(parents=True)
    (tmp_path / "ws/src/half/package.xml").write_text("<package/>")
    (tmp_path / "home").mkdir()
    return Workspace(tmp_path / "ws", environment.find(), tmp_path / "home")


def write(workspace: Workspace, text: str, name: str = "test_half.py") -> None:
    (workspace.root / "src/half/test" / name).write_text(text)


def run_all(workspace: Workspace, *orders: TestRun) -> list[Report]:
    return run(workspace, read_source(workspace, "half"), [replace(order, is_public=True) for order in orders])


def test_good_tests_pass_on_a_right_version_and_fail_on_a_wrong_one(workspace: Workspace) -> None:
    write(workspace, GOOD)
    right, wrong = run_all(workspace, TestRun(("test_half.py",), RIGHT), TestRun(("test_half.py",), WRONG))
    assert right.passed
    assert right.executed == ("test_half::test_odd", "test_half::test_even")
    assert wrong.failed == ("test_half::test_odd",)
    assert wrong.claims.messages["test_half::test_odd"].startswith("assert 1 == 1.5")
    assert wrong.detects_fault(right)
    assert not right.detects_fault(right)


TELLTALE = """import inspect
import sys
import warnings

import half
import pytest

SECRET = inspect.getsource(half)
print(SECRET, file=sys.stderr)
warnings.warn(SECRET)


def test_known():
    raise AssertionError(SECRET)


@pytest.mark.parametrize("case", [SECRET, *SECRET], ids=[SECRET, *map(ascii, SECRET)])
def test_cases(case):
    open(SECRET)


globals()[f"test_{SECRET}"] = test_known


class TestNamed:
    def test_inside(self):
        pytest.fail(SECRET)


TestNamed.__name__ = TestNamed.__qualname__ = SECRET
"""


def test_a_run_on_a_hidden_version_returns_no_text_of_its_own(workspace: Workspace) -> None:
    write(workspace, TELLTALE)
    source, order = read_source(workspace, "half"), TestRun(("test_half.py",), WRONG)
    hidden, repeated = run(workspace, source, [order, order])
    names = {name.partition("[#")[0] for name in hidden.claims.verdicts}
    assert names == {"test_half::test_known", "test_half::test_cases", "test_half::TestNamed::test_inside", "a test"}
    assert not hidden.output
    assert not hidden.claims.messages
    for text in ("return", "x // 2", "def half"):
        assert text not in repr(hidden)
    (visible,) = run_all(workspace, order)
    assert "x // 2" in repr(visible)
    # The same test has the same name in each run, so that verdicts can be compared.
    assert hidden.claims.verdicts == repeated.claims.verdicts
    assert len(hidden.claims.verdicts) == len(visible.claims.verdicts)


def test_a_run_can_stop_at_the_first_failure_and_run_in_reverse_order(workspace: Workspace) -> None:
    write(workspace, GOOD)
    first, backwards = run_all(
        workspace,
        TestRun(("test_half.py",), WRONG, exit_first=True),
        TestRun(("test_half.py",), RIGHT, backwards=True),
    )
    assert first.executed == ("test_half::test_odd",)
    assert backwards.executed == ("test_half::test_even", "test_half::test_odd")


def test_tests_that_cannot_be_imported_find_no_fault(workspace: Workspace) -> None:
    write(workspace, GOOD)
    (right,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, "import no_such_module\n" + GOOD)
    (report,) = run_all(workspace, TestRun(("test_half.py",), WRONG))
    assert report.status == 2
    assert not report.detects_fault(right)


def test_a_run_without_tests_does_not_pass(workspace: Workspace) -> None:
    write(workspace, "import pytest\n\n\n@pytest.mark.skip(reason='later')\ndef test_it():\n    assert False\n")
    (skipped,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, "X = 1\n")
    (empty,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert skipped.status == 0
    assert not skipped.passed
    assert empty.status == 5
    assert not empty.passed


@pytest.mark.parametrize(
    "code",
    [
        "import os\nos._exit(0)",
        "import sys\nprint('2 passed', '<testsuite tests=\"2\"/>')\nsys.exit(0)",
        "import os, signal\nos.kill(os.getpid(), signal.SIGKILL)",
    ],
    ids=["_exit", "exit", "kill"],
)
def test_a_run_that_exits_early_reports_no_test(workspace: Workspace, code: str) -> None:
    write(workspace, code + "\n" + GOOD)
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert not report.passed
    assert "test_half::test_odd" not in report.executed


@pytest.mark.parametrize(
    "reply",
    ["0\\n", "-1\\n", "all passed\\n", "0", "9" * 100],
    ids=["no XML", "negative", "words", "torn", "endless"],
)
def test_an_invalid_reply_of_a_run_reports_no_test(workspace: Workspace, reply: str) -> None:
    # Written to each descriptor of the host: that of the report, of the status, and the one that it waits for.
    code = f"import os, sys\nfor fd in range(3, 64):\n    try:\n        os.write(fd, b'{reply}')\n"
    code += "    except OSError:\n        pass\nos._exit(0)\n"
    write(workspace, code + GOOD)
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert not report.passed
    assert report.executed == ()


def test_a_report_that_is_not_a_file_contains_no_tests(workspace: Workspace) -> None:
    code = """
import pytest

@pytest.fixture(autouse=True)
def folder(request):
    yield
    path = request.config.option.xmlpath
    import os
    os.makedirs(path, exist_ok=True)

"""
    write(workspace, code + GOOD)
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert not report.passed
    assert report.executed == ()


def test_a_run_that_does_not_end_is_stopped(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    limits = replace(TEST_RUN, wall_seconds=4.0)
    monkeypatch.setattr(student_test_runs.sandboxed, "__kwdefaults__", {"limits": limits, "network": False})
    write(workspace, GOOD + "\n\ndef test_for_ever():\n    import signal\n    while True:\n        signal.pause()\n")
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert report.exit_reason is ExitReason.WALL_TIME
    assert not report.passed


@pytest.mark.parametrize(
    ("hangs", "exit_reasons"),
    [
        pytest.param(1, (ExitReason.EXITED, ExitReason.EXITED), id="once, where rclpy missed the end of an executor"),
        pytest.param(2, (ExitReason.WALL_TIME, ExitReason.WALL_TIME), id="on every version, as tests that never end"),
    ],
)
def test_the_only_stopped_run_is_repeated_once(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch, hangs: int, exit_reasons: tuple[ExitReason, ...]
) -> None:
    write(workspace, GOOD)
    original_run, stopped = student_test_runs._run, itertools.count()

    def run_or_stop(*run: Any) -> Report:
        report = original_run(*run)
        return report if next(stopped) >= hangs else replace(report, exit_reason=ExitReason.WALL_TIME)

    monkeypatch.setattr(student_test_runs, "_run", run_or_stop)
    reports = run_all(workspace, TestRun(("test_half.py",), RIGHT), TestRun(("test_half.py",), WRONG))
    assert tuple(report.exit_reason for report in reports) == exit_reasons


def test_a_run_ends_no_sooner_than_the_threads_of_its_tests(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        student_test_runs.sandboxed, "__kwdefaults__", {"limits": replace(TEST_RUN, wall_seconds=4.0), "network": False}
    )
    text = (
        "import threading\n\n\ndef test_it():\n    threading.Thread(target=threading.Event().wait, daemon={}).start()\n"
    )
    write(workspace, text.format(True))
    (short,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, text.format(False))
    (endless,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert short.exit_reason is ExitReason.EXITED
    assert endless.exit_reason is ExitReason.WALL_TIME
    assert short.passed
    assert endless.passed


def test_no_run_sees_files_of_another_run(workspace: Workspace) -> None:
    write(
        workspace,
        "import os\nfrom pathlib import Path\n\n\ndef test_first():\n    mark = Path(os.environ['HOME'], 'mark')\n"
        "    assert not mark.exists()\n    mark.touch()\n",
    )
    assert all(run_all(workspace, TestRun(("test_half.py",), RIGHT))[0].passed for _ in range(3))


def test_the_paths_of_two_versions_differ_only_in_a_random_word(workspace: Workspace) -> None:
    # Outside a worker sandbox, a run takes the first free ROS domain of the machine, whatever its version.
    variables = "sorted({**os.environ, 'ROS_DOMAIN_ID': ''}.items())"
    paths = f"re.sub(r'/tests-[a-z0-9_]{{8}}/', '/', str((half.__file__, os.getcwd(), sys.path, {variables})))"
    write(workspace, f"import os, re, sys\n\nimport half\n\n\ndef test_place():\n    assert not hash({paths})\n")
    reports = [run_all(workspace, TestRun(("test_half.py",), version))[0] for version in (RIGHT, WRONG)]
    messages = {report.claims.messages["test_half::test_place"] for report in reports}
    assert len(messages) == 1
    assert messages.pop().startswith("assert not ")


def test_a_context_that_a_test_does_not_shut_down_is_detected(workspace: Workspace) -> None:
    setup = (
        "import rclpy\nfrom rclpy.context import Context\n\nKEPT = []\n\n\ndef test_it():\n    context = Context()\n"
    )
    setup += "    rclpy.init(context=context)\n    node = rclpy.create_node('n', context=context)\n"
    write(workspace, setup + "    KEPT.append(node)\n")
    (unclosed,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, setup + "    node.destroy_node()\n    rclpy.try_shutdown(context=context)\n")
    (clean,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, setup + "    node.destroy_node()\n")
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert unclosed.passed
    assert unclosed.open_sockets > 0
    assert clean.passed
    assert (clean.open_sockets, clean.is_logging) == (0, False)
    assert report.passed
    assert (report.open_sockets, report.is_logging) == (0, True)


@pytest.mark.parametrize(
    ("init", "more", "joins"),
    [
        ("", "", True),
        ("domain_id=int(os.environ['ROS_DOMAIN_ID'])", "LOCALHOST", True),
        ("domain_id=7", "", False),
        ("", "OFF", False),
    ],
    ids=["default", "on this machine", "own domain", "hidden"],
)
def test_joining_the_default_domain_is_detected(workspace: Workspace, init: str, more: str, joins: bool) -> None:
    text = "import os\nimport rclpy\nfrom rclpy.context import Context\n\n\ndef test_it():\n    context = Context()\n"
    text += f"    os.environ['ROS_AUTOMATIC_DISCOVERY_RANGE'] = '{more}'\n" if more else ""
    text += f"    rclpy.init(context=context, {init})\n    node = rclpy.create_node('n', context=context)\n"
    text += "    node.destroy_node()\n    rclpy.try_shutdown(context=context)\n"
    write(workspace, text)
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT, sniffed=True))
    assert report.passed, report.output
    assert report.joined_domain is joins


def test_a_run_that_joins_no_domain_is_not_reported(workspace: Workspace) -> None:
    write(workspace, GOOD)
    (report,) = run_all(workspace, TestRun(("test_half.py",), RIGHT, sniffed=True))
    assert report.passed
    assert not report.joined_domain


def test_only_tests_that_mention_launch_get_the_launch_plugin(workspace: Workspace) -> None:
    ask = "def test_it(pytestconfig):\n    assert {}pytestconfig.pluginmanager.has_plugin('lau' 'nch_pytest.plugin')\n"
    write(workspace, ask.format("not "))
    (plain,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, "# launch\n" + ask.format(""))
    (mentioning,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    write(workspace, ask.format(""))
    write(workspace, "# launch\n", "conftest.py")
    (shared,) = run_all(workspace, TestRun(("test_half.py",), RIGHT))
    assert [plain.passed, mentioning.passed, shared.passed] == [True, True, True]


def test_a_package_without_a_folder_of_its_name_is_named(workspace: Workspace) -> None:
    with pytest.raises(StudentError, match=r"There is no folder src/other with a package\.xml"):
        read_source(workspace, "other")


def test_a_link_that_the_build_left_among_the_tests_is_refused(workspace: Workspace) -> None:
    (workspace.root / "src/half/test/secrets").symlink_to("/etc")
    with pytest.raises(StudentError):
        read_source(workspace, "half")


def test_the_students_own_package_is_tested_as_it_was_built(workspace: Workspace) -> None:
    site = workspace.install / f"half/lib/python{sys.version_info[0]}.{sys.version_info[1]}/site-packages/half"
    site.mkdir(parents=True)
    (site / "__init__.py").write_text("def half(x):\n    return x / 2\n")
    write(workspace, GOOD)
    (report,) = run_all(workspace, TestRun(("test_half.py",)))
    assert report.passed


def test_a_full_disk_is_the_students_fault(workspace: Workspace, monkeypatch: pytest.MonkeyPatch) -> None:
    def full(*_: object) -> Path:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    write(workspace, GOOD)
    monkeypatch.setattr(student_test_runs, "write_version", full)
    with pytest.raises(StudentError, match="The disk is full"):
        run_all(workspace, TestRun(("test_half.py",), RIGHT))
