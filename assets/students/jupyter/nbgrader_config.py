"""Tells nbgrader which course this is, and where the class exchanges its work: the folder that a hub names."""

import os

from autograder import course_paths

c = get_config()  # noqa: F821 (traitlets defines it for a configuration file)
c.CourseDirectory.course_id = course_paths.course().name
if exchange := os.environ.get("NBGRADER_EXCHANGE"):
    c.Exchange.root = exchange
