"""`source` makes the interfaces of a workspace importable in the kernel, and reports mistakes in plain words."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from autograder.building.interfaces.prefix import build
from autograder.exceptions import UsageError
from autograder.notebook import source
from autograder.notebook.notices import Notice
from sim.grading import GRADING_VARIABLE

# A separate process, like a kernel: its imports and settings would otherwise stay in this one.
KERNEL = """
import sys
from pathlib import Path
from autograder.notebook import ros, source

ros()
print(source(sys.argv[1]))
from course_words.msg import Word
import rclpy

rclpy.init()
node = rclpy.create_node("kernel")
node.create_publisher(Word, "words", 1).publish(Word(text="hello"))
print(source(sys.argv[1]))
definition = Path(sys.argv[1], "install/course_words/share/course_words/msg/Word.msg")
definition.write_text("string text\\nint32 more\\n")
print(source(sys.argv[1]))
rclpy.shutdown()
"""


def test_a_missing_or_unbuilt_workspace_is_named(tmp_path: Path) -> None:
    with pytest.raises(
        UsageError, match=r"the folder .* does not exist: run this in the assignment's folder, which contains ws"
    ):
        source(tmp_path / "ws")
    with pytest.raises(UsageError, match="has not been built: run colcon build"):
        source(tmp_path)
    (tmp_path / "install").mkdir()
    with pytest.raises(UsageError, match="has not been built: run colcon build"):
        source(tmp_path)


def test_no_workspace_is_sourced_while_the_notebook_is_graded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(GRADING_VARIABLE, "1")
    assert isinstance(source("/no/where"), Notice)


@pytest.mark.slow
def test_interfaces_built_beside_a_kernel_can_be_imported_and_sent_and_old_ones_are_reported(tmp_path: Path) -> None:
    prefix = tmp_path / "install" / "course_words"
    prefix.parent.mkdir()
    # The layout of colcon: the generated libraries are in lib, where a running process does not look for them.
    built = build("course_words", {"msg/Word.msg": "string text\n"})
    (prefix / "share/course_words/msg").mkdir(parents=True)
    (prefix / "share/course_words/msg/Word.msg").write_text("string text\n")
    (prefix / "lib").symlink_to(built / "lib")
    completed = subprocess.run(
        [sys.executable, "-c", KERNEL, str(tmp_path)], capture_output=True, text=True, env=os.environ, timeout=120
    )
    assert completed.returncode == 0, completed.stderr
    first, second, third = (line for line in completed.stdout.splitlines() if "kernel" in line)
    assert first == second == "This kernel can use course_words."
    assert third.startswith("This kernel still uses the old course_words: choose Kernel, Restart")
