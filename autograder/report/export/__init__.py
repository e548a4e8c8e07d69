"""Exports stored results: CSV, JUnit XML, Gradescope, HTML and Markdown.

`write(load(path), "csv", out)` reads every result below `path` and writes one of `FORMATS`.
"""

from autograder.report.export.formats import FORMATS, write
from autograder.report.export.stored import load

__all__ = ["FORMATS", "load", "write"]
