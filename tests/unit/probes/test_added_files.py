"""Files added to a copy of a student's package can conflict with the student's own files."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.exceptions import StudentError
from autograder.harness import Workspace
from autograder.probes.added_files import install_with
from autograder.ros import activate


@pytest.mark.parametrize(
    ("existing", "added"), [("test/__init__.py/a", "test/__init__.py"), ("wheels/new", "wheels/new/a.py")]
)
def test_a_conflict_of_a_file_and_a_folder_is_the_student_s_fault(existing: str, added: str, tmp_path: Path) -> None:
    package = tmp_path / "ws" / "src" / "wheels"
    (package / existing).parent.mkdir(parents=True)
    (package / existing).write_text("")
    (package / "package.xml").write_text("<package><name>wheels</name></package>")
    workspace = Workspace(tmp_path / "ws", activate(), tmp_path)
    with pytest.raises(StudentError, match=f"wheels/{added} cannot be read: .* The check adds a file with this name"):
        install_with(workspace, "wheels", [added])
