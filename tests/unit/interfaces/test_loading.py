"""Message packages that depend on each other are loaded within the limits of a single one."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder.building.interfaces.loading import load_interfaces
from autograder.exceptions import StudentError
from autograder.ros import find
from autograder.run.workspace import Workspace

MANIFEST = """<package format="3"><name>{name}</name><version>0.0.0</version><description>d</description>
<maintainer email="a@b.cd">m</maintainer><license>x</license></package>"""


@pytest.fixture
def workspace(tmp_path: Path) -> Workspace:
    texts = {"sample_msgs": "int8[90000] x\n", "many_msgs": "sample_msgs/M[700] x\n", "most_msgs": "many_msgs/M x\n"}
    for name, text in texts.items():
        (tmp_path / "src" / name / "msg").mkdir(parents=True)
        (tmp_path / "src" / name / "package.xml").write_text(MANIFEST.format(name=name))
        (tmp_path / "src" / name / "msg" / "M.msg").write_text(text)
    return Workspace(tmp_path, find(), tmp_path)


def test_array_sizes_are_multiplied_through_all_packages_of_a_submission(workspace: Workspace) -> None:
    assert load_interfaces(workspace, "sample_msgs").msg.M.__name__ == "M"
    with pytest.raises(StudentError, match=r"src/many_msgs: msg/M\.msg.*arrays of more than 100000 elements"):
        load_interfaces(workspace, "most_msgs")
