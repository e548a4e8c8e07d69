"""The commands of the guide to a JupyterHub work as written, with other names."""

from __future__ import annotations

import os
import re
import secrets
import subprocess
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.lms.hub.trial import Hub, running_hub
from autograder.lms.hub.users import MARK, remove_users
from autograder.ros.environment import find, without_wheel_bootstrap
from tests.e2e.test_hub import check_a_class, shared_folder

__all__ = ["shared_folder"]

pytestmark = [
    pytest.mark.nightly,
    pytest.mark.timeout(7200),
    pytest.mark.skipif(os.geteuid() != 0, reason="only root can make users and start their servers"),
]
GUIDE = course_paths.ROOT / "docs" / "jupyterhub.md"
SYSTEM_PATH = "/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin"


def commands_of_the_guide(heading: str) -> str:
    """Return the commands in the console blocks of a section of the guide, one per line."""
    text = GUIDE.read_text(encoding="utf-8").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    blocks = re.findall(r"```console\n(.*?)```", text, flags=re.DOTALL)
    return "\n".join(re.sub(r"^[$#] ", "", line) for block in blocks for line in block.splitlines())


@contextmanager
def hub_of_the_guide(shared_folder: Path) -> Iterator[tuple[Hub, str]]:
    """Run the guide's commands with other names; yield the hub's data, and the last command, which starts the hub."""
    suffix, password = shared_folder.name[-6:].lower().replace("_", "x"), secrets.token_urlsafe(9)
    students, teachers = f"ros2-students-{suffix}", f"ros2-teachers-{suffix}"
    names = {name: f"{name}-{suffix}" for name in ("ada", "ben", "tess")}
    script = commands_of_the_guide("Local users")
    replacements = {
        "/srv/ros2": str(shared_folder / "srv"),
        "ros2-students": students,
        "ros2-teachers": teachers,
        "PASSWORD": password,
    }
    for text, replacement in {**replacements, "URL-OF-THE-REPOSITORY": str(course_paths.ROOT)}.items():
        script = script.replace(text, replacement)
    # The comment marks the users that are removed after the test.
    script = script.replace("useradd ", f"useradd --comment {MARK!r} ")
    for name, replacement in names.items():
        script = re.sub(rf"\b{name}\b", replacement, script)
    *lines, serve = script.splitlines()
    groups = {students: [names["ada"], names["ben"]], teachers: [names["tess"]]}
    configuration = shared_folder / "srv" / "repository" / "assets" / "hub" / "jupyterhub_config.py"
    try:
        # As in a new shell, without the ROS of these tests.
        ros = {*find().variables(), "ROS_DOMAIN_ID", "PYTHONPATH"}
        shell = {name: value for name, value in without_wheel_bootstrap(os.environ).items() if name not in ros}
        process = subprocess.run(
            ["bash", "-exc", "\n".join(lines)],
            cwd=shared_folder,
            env={**shell, "PATH": SYSTEM_PATH},
            capture_output=True,
            text=True,
            check=False,
        )
        assert process.returncode == 0, process.stdout[-3000:] + process.stderr[-3000:]
        text = configuration.read_text(encoding="utf-8")
        configuration.write_text(text.replace("ros2-students", students).replace("ros2-teachers", teachers))
        yield Hub("", password, (names["ada"], names["ben"]), names["tess"], Path("/home")), serve
    finally:
        remove_users(groups)


@pytest.mark.promise("These commands make a hub for a class on one machine, as root.")
def test_the_commands_of_the_guide_make_a_hub_for_a_class(shared_folder: Path) -> None:
    with (
        hub_of_the_guide(shared_folder) as (hub, serve),
        running_hub(shared_folder, ("bash", "-c", f'{serve} "$@"', "hub")) as url,
    ):
        check_a_class(replace(hub, url=url), with_reference=True)
