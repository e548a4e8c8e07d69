"""Draws robot.png, the README's picture: the reference controller drives for a minute in the world `lab`.

.venv/bin/python assets/figures/robot.py
"""

from __future__ import annotations

import tempfile
from pathlib import Path

from autograder.author.verification.mutants import write_reference
from autograder.notebook import drive
from autograder.notebook.driving import DriveReport

OUT = Path(__file__).with_suffix(".png")


def main() -> None:
    """Drive, and save the picture of the track."""
    with tempfile.TemporaryDirectory() as folder:
        write_reference(("my_robot_package",), Path(folder))
        report = drive("my_robot_package", "robot_controller", "lab", 60.0, workspace=folder)
    assert isinstance(report, DriveReport), report
    print(report.picture.alt)
    report.picture.save(OUT, dpi=110)


if __name__ == "__main__":
    main()
