"""The autograder: visible checks for students, isolated grading for instructors.

The command line is `autograder` (`autograder --help`); what notebooks import is `autograder.notebook`.
"""

__version__ = "0.2.0"
