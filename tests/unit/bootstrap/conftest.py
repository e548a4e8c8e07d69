"""A clone to set up, and commands that are recorded instead of run."""

from __future__ import annotations

from pathlib import Path

import pytest

LOCK = """\
numpy==2.5.0 ; python_full_version >= '3.12' \\
    --hash=sha256:00
ros-rclpy==7.1.6 \\
    --hash=sha256:01 \\
    --hash=sha256:02
ros-wheels-bootstrapper==0.1.2 \\
    --hash=sha256:03
rosbags==0.10 \\
    --hash=sha256:04
"""


class Commands:
    """Records commands instead of running them, and makes the one file that a set-up looks for."""

    def __init__(self, root: Path) -> None:
        self.root = root
        self.ran: list[str] = []
        self.failing = ""
        self.interrupting = ""

    def __call__(self, *command: str, quiet: bool = False) -> int:
        line = " ".join(command)
        self.ran.append(line)
        if self.interrupting and self.interrupting in line:
            raise KeyboardInterrupt
        if self.failing and self.failing in line:
            return 3
        if "-m venv" in line:
            python = self.root / ".venv/bin/python"
            python.parent.mkdir(parents=True)
            python.touch()
        return 0

    def take(self) -> list[str]:
        """Return the commands since the last call, one word each."""
        words = {
            "-m venv": "venv",
            "requirements.lock": "base",
            "requirements-dev.lock": "dev",
            "-e ": "project",
            "ros.patch_wheels": "patch",
            "ros.real_launch --set-up": "launch",
            "interfaces.tutorials": "tutorials",
            "--target": "pip",
        }
        ran = [word for line in self.ran for key, word in words.items() if key in line]
        self.ran.clear()
        return ran


@pytest.fixture
def clone(tmp_path: Path) -> Path:
    """A clone's root, with the files that a set-up depends on."""
    root = tmp_path / "clone"
    for name in (
        "requirements.lock",
        "requirements-dev.lock",
        "pyproject.toml",
        "autograder/ros/patch_wheels.py",
        "autograder/building/interfaces/tutorials.yaml",
    ):
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(LOCK)
    return root


@pytest.fixture
def commands(clone: Path) -> Commands:
    return Commands(clone)
