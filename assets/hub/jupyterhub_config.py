"""Configures the hub of a class on one machine; docs/jupyterhub.md shows how to create its folders and groups."""

from pathlib import Path

from autograder.lms.hub.configuration import configure

PARENT = Path(__file__).resolve().parents[3]  # the folder that contains the repository, such as /srv/ros2

c = get_config()  # noqa: F821 (traitlets defines it for a configuration file)
configure(
    c,
    course=PARENT / "course",
    exchange=PARENT / "exchange",
    proxy=PARENT / "proxy",
    students="ros2-students",
    teachers="ros2-teachers",
)
