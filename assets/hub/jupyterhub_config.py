"""Configures the hub of a class on one machine; docs/jupyterhub.md shows what makes its folders and groups."""

from pathlib import Path

from autograder.lms.hub.configuration import configure

PLACE = Path(__file__).resolve().parents[3]  # around the repository: /srv/ros2

c = get_config()  # noqa: F821 (traitlets defines it for a configuration file)
configure(
    c,
    course=PLACE / "course",
    exchange=PLACE / "exchange",
    proxy=PLACE / "proxy",
    students="ros2-students",
    teachers="ros2-teachers",
)
