"""The autograder: visible checks for students, isolated grading for instructors.

The command line is `autograder` (see `autograder --help`). Notebooks import `autograder.notebook`.
"""

__version__ = "0.2.0"
