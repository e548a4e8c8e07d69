"""Configures nbgrader, with this folder as the course directory.

The isolated grader (`autograder.lms.nbgrader`) computes the scores, and nbgrader records them. `NBGRADER_EXCHANGE`
sets the exchange folder of a class, which is `.build/exchange` by default.

`nbgrader autograde` grades one submission at a time. These commands grade a class on 8 cores and record the scores:

    autograder grade submitted --assignment ID --out .build/nbgrader/ID -j 8
    nbgrader autograde ID
"""

from pathlib import Path

from autograder.lms.nbgrader.configuration import configure

configure(get_config(), Path(__file__).resolve().parent)  # noqa: F821 (traitlets defines it for a configuration file)
