"""Configures nbgrader: the name of the course, and the exchange folder that a hub sets."""

import os

from autograder import course_paths

c = get_config()  # noqa: F821 (traitlets defines it for a configuration file)
c.CourseDirectory.course_id = course_paths.course().name
if exchange := os.environ.get("NBGRADER_EXCHANGE"):
    c.Exchange.root = exchange
