"""Stored results turned into what others read: spreadsheets, CI, Gradescope, a web page, a report in Markdown.

`write(load(path), "csv", out)` reads every result below `path` and writes one format; `FORMATS` names them. Nothing
is graded here.
"""

from autograder.export.formats import FORMATS, write
from autograder.export.stored import Stored, load

__all__ = ["FORMATS", "Stored", "load", "write"]
