"""The course's `%%writefile` keeps a student's changes."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from IPython.core.interactiveshell import InteractiveShell
from IPython.testing.globalipapp import start_ipython

from autograder.exceptions import UsageError
from autograder.notebook.writefile import REPLACED, STUB, register
from autograder.notebook.written_record import RECORD
from autograder.submission.exercise_stubs import CODE_STUB

UNSOLVED = f"def main():\n    {CODE_STUB}\n"
HALF = f"def main():\n    return 0\n\n\ndef other():\n    {CODE_STUB}\n"
SOLVED = "def main():\n    return 0\n"
OTHER = "def main():\n    return 1\n"
Run = Callable[..., str]
FILE = "ws/src/pkg/node.py"


def test_a_stub_of_releases_contains_the_text_that_writefile_looks_for() -> None:
    assert STUB in CODE_STUB


@pytest.fixture(scope="module")
def shell() -> InteractiveShell:
    interpreter = start_ipython() or InteractiveShell.instance()
    register(interpreter)
    register(interpreter)
    return interpreter


@pytest.fixture
def run(
    shell: InteractiveShell, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> Run:
    """Run a `%%writefile` cell in an empty folder; return its output."""
    monkeypatch.chdir(tmp_path)
    Path(FILE).parent.mkdir(parents=True)

    def run_cell(text: str, line: str = FILE) -> str:
        shell.run_cell_magic("writefile", line, text)
        return capsys.readouterr().out

    return run_cell


@pytest.mark.parametrize(
    ("cell", "on_disk", "recorded", "notice"),
    [
        (UNSOLVED, None, None, "Writing"),
        (UNSOLVED, UNSOLVED, None, "Overwriting"),
        (UNSOLVED, SOLVED, None, "was kept"),
        (UNSOLVED, SOLVED, SOLVED, "was kept"),  # the cell was solved once and has lost its answer
        (UNSOLVED, "", None, "was kept"),
        (UNSOLVED + UNSOLVED, HALF, None, "was kept"),
        (HALF, UNSOLVED, UNSOLVED, "Overwriting"),
        (HALF, UNSOLVED + "# mine\n", UNSOLVED, "was changed outside of this cell"),
        (SOLVED, UNSOLVED, UNSOLVED, "Overwriting"),
        (SOLVED, OTHER, OTHER, "Overwriting"),
        (SOLVED, OTHER, UNSOLVED, "was changed outside of this cell"),
        (SOLVED, OTHER, None, "was changed outside of this cell"),
    ],
)
def test_a_file_is_written_kept_or_copied_first(
    run: Run, cell: str, on_disk: str | None, recorded: str | None, notice: str
) -> None:
    if recorded is not None:
        run(recorded)
    if on_disk is not None:
        Path(FILE).write_text(on_disk)
    output = run(cell)
    assert notice in output
    assert ("was kept" in output, "was changed" in output) == ("was kept" in notice, "was changed" in notice)
    assert Path(FILE).read_text() == (on_disk if "was kept" in notice else cell)


@pytest.mark.promise("It writes a file of a real ROS package into `ws/src`, beside the notebook.")
def test_a_cell_writes_its_file_and_writes_it_again(run: Run) -> None:
    assert run(UNSOLVED) == f"Writing {FILE}\n"
    assert run(SOLVED) == f"Overwriting {FILE}\n"
    assert Path(FILE).read_text() == SOLVED
    assert not Path("ws", REPLACED).exists()


def test_an_untouched_cell_does_not_replace_a_file_from_the_editor(run: Run) -> None:
    run(UNSOLVED)
    Path(FILE).write_text(SOLVED)
    assert f"{FILE} was kept as it is" in run(UNSOLVED)
    assert Path(FILE).read_text() == SOLVED


def test_a_changed_file_is_copied_before_a_cell_replaces_it(run: Run) -> None:
    run(SOLVED)
    for number, text in enumerate((OTHER, OTHER + "# more\n"), 1):
        Path(FILE).write_text(text)
        output = run(SOLVED)
        copy = Path("ws", REPLACED, "src/pkg", f"node.py.{number}")
        assert f"Its old text was copied to {copy}." in output
        assert copy.read_text() == text
    assert Path(FILE).read_text() == SOLVED
    assert Path("ws", REPLACED, "COLCON_IGNORE").is_file()


@pytest.mark.parametrize("damage", ["", "[1]", "{", '{"src/pkg/node.py": 5}'])
def test_without_a_readable_record_a_file_is_copied(run: Run, damage: str) -> None:
    run(OTHER)
    Path("ws", RECORD).write_text(damage)
    assert "was copied to" in run(SOLVED)


def test_binary_files_are_copied_unchanged(run: Run) -> None:
    Path(FILE).write_bytes(b"\xff\x00\r\n")
    run(SOLVED)
    assert Path("ws", REPLACED, "src/pkg/node.py.1").read_bytes() == b"\xff\x00\r\n"


def test_appending_and_names_in_quotes_work_as_before(run: Run) -> None:
    run(SOLVED)
    assert run("# end\n", f"-a {FILE}") == f"Appending to {FILE}\n"
    assert Path(FILE).read_text() == SOLVED + "# end\n"
    assert run(SOLVED) == f"Overwriting {FILE}\n"  # the text that cells appended was not edited
    assert run(SOLVED, '"ws/a file.py"') == "Writing ws/a file.py\n"
    assert Path("ws/a file.py").read_text() == SOLVED


@pytest.mark.promise("`%%writefile` makes the folder `launch`.")
def test_a_cell_makes_the_missing_folders_of_its_file_and_says_so(run: Run) -> None:
    file = "ws/src/new_pkg/launch/robot.launch.py"
    assert run(SOLVED, file) == f"Created the folder ws/src/new_pkg/launch\nWriting {file}\n"
    assert Path(file).read_text() == SOLVED
    assert run(SOLVED, file) == f"Overwriting {file}\n"
    assert run("# end\n", "-a ws/src/new_pkg/config/more.yaml").startswith("Created the folder ws/src/new_pkg/config\n")


@pytest.mark.parametrize("below", ["robot.launch.py", "deep/er/robot.launch.py"])
def test_a_file_with_the_name_of_a_needed_folder_is_named(run: Run, below: str) -> None:
    Path("ws/src/pkg/launch").write_text("a file\n")
    with pytest.raises(
        UsageError, match=r"^ws/src/pkg/launch is a file, so the folder .* cannot be created: rename one"
    ):
        run(SOLVED, f"ws/src/pkg/launch/{below}")
    assert Path("ws/src/pkg/launch").read_text() == "a file\n"


def test_registering_the_magic_without_a_shell_does_nothing() -> None:
    register(None)
