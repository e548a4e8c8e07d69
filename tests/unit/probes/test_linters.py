"""Linters check a package, whatever the student's tests named after linters do."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.harness import Workspace
from autograder.probes.linters import expect_tidy, lint
from autograder.probes.student_test_runs import read_source
from autograder.ros import environment
from autograder.ros.ros2.pkg_templates import PYTHON_TESTS
from autograder.suite import CheckFailed

pytestmark = pytest.mark.slow  # each run is a pytest of its own

TIDY = '"""Halves."""\n\n\ndef half(x):\n    """Return a half of x."""\n    return x / 2\n'
SILENT = "def test_flake8():\n    pass\n\n\ndef test_pep257():\n    pass\n"
TESTS = ("test_flake8::test_flake8", "test_pep257::test_pep257")
EMPTYING_CONFTEST = (
    '"""Lets no test run."""\n\n\ndef pytest_collection_modifyitems(items):\n    """Run none."""\n    items.clear()\n'
)


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    """A workspace with a package `half`, whose own style tests check nothing."""
    folder = tmp_path / "ws/src/half"
    for path, text in {
        "package.xml": "<package/>",
        "half.py": TIDY,
        "test/test_flake8.py": SILENT,
        "test/test_pep257.py": SILENT,
        "test/conftest.py": EMPTYING_CONFTEST,
    }.items():
        (folder / path).parent.mkdir(parents=True, exist_ok=True)
        (folder / path).write_text(text)
    (tmp_path / "home").mkdir()
    return Workspace(tmp_path / "ws", environment.find(), tmp_path / "home")


def test_the_linters_report_nothing_about_a_clean_package(workspace: Workspace) -> None:
    assert lint(workspace, read_source(workspace, "half")) == {}


def test_each_linter_names_its_first_finding_even_if_the_students_tests_report_none(
    workspace: Workspace,
) -> None:
    untidy = TIDY.replace("half of x.", "half of x").replace("x / 2", "x/ 2")
    (workspace.root / "src/half/half.py").write_text(untidy)
    findings = lint(workspace, read_source(workspace, "half"))
    assert findings["test_flake8"] == "half.py:6:13: E225 missing whitespace around operator"
    assert findings["test_pep257"].startswith("half.py:5 in public function `half`: D400: ")
    with pytest.raises(
        CheckFailed, match=r"test_flake8 passes, but its linter finds .*: half\.py:6:13: E225"
    ) as excinfo:
        expect_tidy(workspace, read_source(workspace, "half"), TESTS, fraction=0.5)
    assert excinfo.value.fraction == 0.5


def test_the_tests_of_ros2_pkg_create_find_an_inserted_fault_and_empty_tests_do_not(
    workspace: Workspace,
) -> None:
    folder = workspace.root / "src/half/test"
    (folder / "conftest.py").unlink()
    (folder / "test_flake8.py").write_text(PYTHON_TESTS["test_flake8.py"])
    (folder / "test_pep257.py").write_text(SILENT)
    expect_tidy(workspace, read_source(workspace, "half"), TESTS[:1])
    with pytest.raises(CheckFailed, match=r"half/untidy\.py and test/untidy\.py of a copy .*, and test_pep257 passed"):
        expect_tidy(workspace, read_source(workspace, "half"), TESTS)


def test_the_linters_ignore_a_conftest_and_check_it_like_any_other_file(workspace: Workspace) -> None:
    (workspace.root / "src/half/test/conftest.py").write_text(EMPTYING_CONFTEST.replace("Run none.", "Run none"))
    findings = lint(workspace, read_source(workspace, "half"))
    assert list(findings) == ["test_pep257"]
    assert findings["test_pep257"].startswith("test/conftest.py:")


UNUSED = TIDY.replace("\n\n\ndef", "\n\nimport os{}\n\n\ndef")


@pytest.mark.parametrize(
    ("files", "finding"),
    [
        ({"half.py": UNUSED.format("  # noqa")}, "half.py:3:1: F401 'os' imported but unused"),
        ({"half.py": UNUSED.format("  # NoQA : F401")}, "half.py:3:1: F401 'os' imported but unused"),
        ({"half.py": UNUSED.format("") + "# flake8: noqa\n"}, "half.py:3:1: F401 'os' imported but unused"),
        ({"half.py": UNUSED.format(""), "setup.cfg": "[flake8]\nexclude = *\n"}, "half.py:3:1: F401"),
        ({"half.py": UNUSED.format(""), ".flake8": "[flake8]\nignore = F\n"}, "half.py:3:1: F401"),
        ({"half.py": UNUSED.format(""), "AMENT_IGNORE": ""}, "half.py:3:1: F401"),
        ({"half.py": UNUSED.format(""), "test/ament_flake8.py": '"""Nothing."""\n'}, "half.py:3:1: F401"),
    ],
)
def test_flake8_cannot_be_switched_off(workspace: Workspace, files: dict[str, str], finding: str) -> None:
    for path, text in files.items():
        (workspace.root / "src/half" / path).write_text(text)
    assert lint(workspace, read_source(workspace, "half"))["test_flake8"].startswith(finding)


@pytest.mark.parametrize(
    "files",
    [
        {"half.py": TIDY.replace('of x."""', 'of x"""  # noqa')},
        {"half.py": TIDY.replace("half(x):", "half(x):  # noqa: D400").replace("of x.", "of x")},
        {"half.py": TIDY.replace("of x.", "of x"), ".pydocstyle": "[pydocstyle]\nadd-ignore = D400\n"},
        {"half.py": TIDY.replace("of x.", "of x"), "tox.ini": "[pydocstyle]\nadd-ignore = D400\n"},
    ],
)
def test_pep257_cannot_be_switched_off(workspace: Workspace, files: dict[str, str]) -> None:
    for path, text in files.items():
        (workspace.root / "src/half" / path).write_text(text)
    assert "D400" in lint(workspace, read_source(workspace, "half"))["test_pep257"]
