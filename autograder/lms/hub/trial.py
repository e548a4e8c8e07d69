"""A trial hub on this machine: three students and a teacher, the exchange, and one installation of the course.

Students' servers run a release that root owns. The teacher has an nbgrader course directory in the home folder.
"""

from __future__ import annotations

import hashlib
import os
import pwd
import secrets
import shutil
import socket
import subprocess
import sys
import urllib.request
from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from threading import Event
from time import monotonic

from autograder import course_paths
from autograder.bootstrap import closed_to_other_users
from autograder.exceptions import UsageError
from autograder.lms.hub.users import temporary_users

STUDENTS = ("ada", "ben", "cleo")
TEACHER = "teacher"
START_SECONDS = 300.0  # the maximum time until the hub responds
PROXY = course_paths.ROOT / "assets" / "hub"  # contains package.json and npm's lock file
CONFIGURATION = """\
from pathlib import Path
from autograder.lms.hub.configuration import configure

c = get_config()
configure(c, course=Path({course!r}), exchange=Path({exchange!r}), proxy=Path({proxy!r}), students={students!r},
          teachers={teachers!r})
"""


@dataclass(frozen=True)
class Hub:
    """A running hub.

    Attributes:
        url: its address, without a slash at the end.
        password: the password of every user.
        students: the students' names.
        teacher: the teacher's name.
        homes: the parent of the users' home folders.
    """

    url: str
    password: str
    students: tuple[str, ...]
    teacher: str
    homes: Path


def install_release(folder: Path) -> Path:
    """Write a release to `folder/course`, set it up with JupyterHub, and return its path.

    Raises:
        UsageError: the release exists, or its set-up failed.
    """
    course = folder / "course"
    _run(folder, sys.executable, "-m", "autograder", "release", "--out", str(course))
    _run(course, "make", "--silent", "setup", f"PYTHON={Path(sys.executable).resolve()}")
    pip_options = ("--no-deps", "--require-hashes", "-r", str(course_paths.ROOT / "requirements-hub.lock"))
    _run(course, str(course / ".venv" / "bin" / "pip"), "install", "--quiet", *pip_options)
    return course


def install_proxy() -> Path:
    """Install the hub's proxy with npm, at the versions in its lock file, and return its folder.

    An existing installation is reused.

    Raises:
        UsageError: npm failed.
    """
    lock = (PROXY / "package-lock.json").read_bytes()
    proxy = course_paths.ROOT / ".build" / "hub-proxy" / hashlib.sha256(lock).hexdigest()[:12]
    if not (proxy / "node_modules" / ".bin" / "configurable-http-proxy").exists():
        shutil.copytree(PROXY, proxy, dirs_exist_ok=True, ignore=shutil.ignore_patterns("*.py"))
        npm = str(Path(sys.executable).with_name("npm"))
        _run(proxy, npm, "ci", "--omit=dev", "--no-audit", "--no-fund", "--loglevel=error")
    return proxy


@contextmanager
def serving(folder: Path, course: Path, port: int = 0, names: Sequence[str] = STUDENTS) -> Iterator[Hub]:
    """Run a hub with separate users on 127.0.0.1. Afterwards, stop it and remove its users.

    Args:
        folder: a folder that other users can enter, for all files of the hub.
        course: the students' release after `make setup`, which only root can change.
        port: the port of the hub; a free one by default.
        names: the students' names, to each of which a suffix is added.

    Raises:
        UsageError: this user is not root, other users cannot enter the folders, or the hub does not start.
    """
    if os.geteuid() != 0:
        raise UsageError("only root can start the servers of a hub's users: run this with sudo or as root")
    homes, exchange, state = (folder / name for name in ("homes", "exchange", "state"))
    for path, mode in ((homes, 0o755), (exchange, 0o1777), (state, 0o700)):
        shutil.rmtree(path, ignore_errors=True)  # files of an earlier trial, whose users no longer exist
        path.mkdir(parents=True)
        path.chmod(mode)
    for path in (course, homes):
        if problem := closed_to_other_users(Path(sys.executable).resolve(), path):
            raise UsageError(problem)
    suffix = hashlib.sha256(str(folder).encode()).hexdigest()[:6]  # so that each clone on a machine can run a hub
    students = tuple(f"{name}-{suffix}" for name in names)
    hub = Hub("", secrets.token_urlsafe(9), students, f"{TEACHER}-{suffix}", homes)
    groups = {f"students-{suffix}": students, f"teachers-{suffix}": (hub.teacher,)}
    configuration = state / "jupyterhub_config.py"
    configuration.write_text(
        CONFIGURATION.format(
            course=str(course),
            exchange=str(exchange),
            proxy=str(install_proxy()),
            students=f"students-{suffix}",
            teachers=f"teachers-{suffix}",
        )
    )
    with temporary_users(homes, hub.password, groups):
        _make_course_directory(homes / hub.teacher, hub.teacher)
        with running_hub(state, (sys.executable, "-m", "jupyterhub", "-f", str(configuration)), port) as url:
            yield replace(hub, url=url)


def _make_course_directory(home: Path, owner: str) -> None:
    """Copy the chapters to an nbgrader course directory in a teacher's home, with settings that Jupyter finds."""
    course, settings = home / "course", home / ".jupyter"
    chapters = course_paths.course().chapters
    shutil.copytree(course_paths.course().root / chapters, course / chapters, ignore=course_paths.NOT_COPIED)
    shutil.copy(course_paths.course().root / "nbgrader_config.py", course)
    settings.mkdir()
    (settings / "nbgrader_config.py").symlink_to(course / "nbgrader_config.py")
    user = pwd.getpwnam(owner)
    for path in (settings, course, *settings.rglob("*"), *course.rglob("*")):
        os.chown(path, user.pw_uid, user.pw_gid, follow_symlinks=False)


@contextmanager
def running_hub(state: Path, command: Sequence[str], port: int = 0) -> Iterator[str]:
    """Run JupyterHub, and yield its address once it responds.

    Args:
        state: the folder for the hub's data and log.
        command: the command that starts the hub, to which the options for its ports are added.
        port: the port of the hub on 127.0.0.1; a free one by default.

    Raises:
        UsageError: the hub does not start.
    """
    hub_port, internal_port, proxy_port = _free_ports(3)
    url = f"http://127.0.0.1:{port or hub_port}"
    options = (f"--JupyterHub.bind_url={url}", f"--JupyterHub.hub_port={internal_port}")
    command = [*command, *options, f"--ConfigurableHTTPProxy.api_url=http://127.0.0.1:{proxy_port}"]
    environment = {name: value for name, value in os.environ.items() if name not in ("ROS_DOMAIN_ID", "PYTHONPATH")}
    with (state / "log").open("wb") as log:
        hub = subprocess.Popen(command, cwd=state, env=environment, stdout=log, stderr=log, start_new_session=True)
        try:
            _wait(hub, f"{url}/hub/api/", state / "log")
            yield url
        finally:
            hub.terminate()  # it also stops its users' servers and the proxy
            try:
                hub.wait(timeout=60)
            except subprocess.TimeoutExpired:
                hub.kill()
                hub.wait()


def _wait(hub: subprocess.Popen[bytes], url: str, log: Path) -> None:
    deadline, pause = monotonic() + START_SECONDS, Event()
    while hub.poll() is None and monotonic() < deadline:
        try:
            with urllib.request.urlopen(url, timeout=5):
                return
        except OSError:
            pause.wait(0.2)
    raise UsageError(f"the hub did not start; the end of {log}:\n{log.read_text(errors='replace')[-2000:]}")


def _free_ports(count: int) -> list[int]:
    with ExitStack() as stack:
        sockets = [stack.enter_context(socket.create_server(("127.0.0.1", 0))) for _ in range(count)]
        return [int(server.getsockname()[1]) for server in sockets]


def _run(folder: Path, *command: str) -> None:
    bin_folder = str(Path(sys.executable).parent)
    environment = {**os.environ, "PATH": os.pathsep.join([bin_folder, os.environ.get("PATH", os.defpath)])}
    completed = subprocess.run(command, cwd=folder, env=environment, check=False)
    if completed.returncode != 0:
        raise UsageError(f"{' '.join(command)} failed with exit status {completed.returncode}: its output is above")
