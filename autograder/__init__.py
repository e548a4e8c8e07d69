"""The autograder: visible checks for students, isolated grading for instructors.

The command line is `autograder` (see `autograder --help`). Notebooks import `autograder.notebook`.
"""

import sys
from pathlib import Path

__version__ = "0.2.0"

# If a shell starts ../.venv/bin/python, the path of Python leads through the folder that the shell is in. Sandboxes
# lack that folder, so they could start no program.
if ".." in Path(sys.executable).parts:
    sys.executable = str(Path(sys.executable).parent.resolve() / Path(sys.executable).name)
