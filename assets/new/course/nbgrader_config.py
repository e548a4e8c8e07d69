"""Configures nbgrader, with this folder as the course directory.

The isolated grader (`autograder.lms.nbgrader`) computes the scores, and nbgrader records them. `NBGRADER_EXCHANGE`
names the exchange folder of a class. Without it the folder is `.build/exchange`.

`nbgrader autograde` grades one submission after the other. These commands grade a class on all cores, and then record
the results:

    autograder grade submitted --assignment ID --out .build/nbgrader/ID -j 8
    nbgrader autograde ID
"""

from pathlib import Path

from autograder.lms.nbgrader.configuration import configure

configure(get_config(), Path(__file__).resolve().parent)  # noqa: F821 (traitlets defines it for a configuration file)
