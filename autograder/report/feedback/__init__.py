"""Writes feedback as self-contained HTML: a page for each submission, and a table for a class.

`write(result, folder)` writes `folder/feedback.html` with the pictures in the same folder. `write_summary(results,
folder)` writes `folder/index.html`, which links to `<student>/feedback.html`.
"""

from autograder.report.feedback.class_page import write_summary
from autograder.report.feedback.pages import PAGE, write

__all__ = ["PAGE", "write", "write_summary"]
