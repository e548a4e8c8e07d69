"""What a student reads after grading: one self-contained HTML page a submission, and a table of them for a class.

`write(result, folder)` makes `folder/feedback.html` with the pictures found in the same folder; `write_summary(results,
folder)` makes `folder/index.html`, which links to `<student>/feedback.html`.
"""

from autograder.feedback.pages import PAGE, SUMMARY, write, write_summary

__all__ = ["PAGE", "SUMMARY", "write", "write_summary"]
