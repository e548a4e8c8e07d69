"""A hub for trying on this machine: three students and a teacher, the exchange, and one installation of the course.

Students' servers run a release, which root owns. The teacher has a course directory of nbgrader's in the home folder.
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
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from threading import Event
from time import monotonic

from autograder import course_paths
from autograder.bootstrap import closed_to_other_users
from autograder.exceptions import UsageError
from autograder.lms.hub.users import temporary_users

STUDENTS = ("ada", "ben", "cleo")
TEACHER = "teacher"
START_SECONDS = 300.0  # a deadline for the hub, not an expectation
PROXY = course_paths.ROOT / "assets" / "hub"  # package.json, and the lock of npm
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
        password: of each user.
        students: their names.
        teacher: the teacher's name.
        homes: the folder of their home folders.
    """

    url: str
    password: str
    students: tuple[str, ...]
    teacher: str
    homes: Path


def install_release(place: Path) -> Path:
    """Make a release in `place/course`, set it up with JupyterHub, and return its folder.

    Raises:
        UsageError: the folder exists, or the set-up failed.
    """
    course = place / "course"
    _run(place, sys.executable, "-m", "autograder", "release", "--out", str(course))
    _run(course, "make", "--silent", "setup", f"PYTHON={Path(sys.executable).resolve()}")
    pinned = ("--no-deps", "--require-hashes", "-r", str(course_paths.ROOT / "requirements-hub.lock"))
    _run(course, str(course / ".venv" / "bin" / "pip"), "install", "--quiet", *pinned)
    return course


def install_proxy() -> Path:
    """Install the hub's proxy by npm, as its lock pins it, if it is not there; return the folder.

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
def serving(place: Path, course: Path, port: int = 0) -> Iterator[Hub]:
    """Serve a hub with separate users on loopback; stop it and remove its users at the end.

    Args:
        place: a folder that other users can enter, for all that the hub makes.
        course: the students' folder after `make setup`; only root can write to it.
        port: of the hub; a free one by default.

    Raises:
        UsageError: this user is not root, other users cannot enter the folders, or the hub does not start.
    """
    if os.geteuid() != 0:
        raise UsageError("a hub starts its users' servers, and only root can do that: call it by sudo, or as root")
    homes, exchange, state = (place / name for name in ("homes", "exchange", "state"))
    for folder, mode in ((homes, 0o755), (exchange, 0o1777), (state, 0o700)):
        shutil.rmtree(folder, ignore_errors=True)  # of an earlier trial, whose users are gone
        folder.mkdir(parents=True)
        folder.chmod(mode)
    for folder in (course, homes):
        if closed := closed_to_other_users(Path(sys.executable).resolve(), folder):
            raise UsageError(closed)
    suffix = hashlib.sha256(str(place).encode()).hexdigest()[:6]  # two clones of one machine can each have a hub
    students = tuple(f"{name}-{suffix}" for name in STUDENTS)
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
        with running(state, (sys.executable, "-m", "jupyterhub", "-f", str(configuration)), port) as url:
            yield Hub(url, hub.password, hub.students, hub.teacher, hub.homes)


def _make_course_directory(home: Path, owner: str) -> None:
    """Give a teacher the chapters as a course directory of nbgrader's, with its settings where Jupyter finds them."""
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
def running(state: Path, command: Sequence[str], port: int = 0) -> Iterator[str]:
    """Run JupyterHub in the folder `state`; yield its address once it answers.

    Args:
        state: where the hub keeps its data and its log.
        command: starts the hub; options of ports are added to it.
        port: of the hub on loopback; a free one by default.

    Raises:
        UsageError: the hub does not start.
    """
    free = _free_ports(3)
    url = f"http://127.0.0.1:{port or free[0]}"
    ports = (f"--JupyterHub.bind_url={url}", f"--JupyterHub.hub_port={free[1]}")
    command = [*command, *ports, f"--ConfigurableHTTPProxy.api_url=http://127.0.0.1:{free[2]}"]
    environment = {name: value for name, value in os.environ.items() if name not in ("ROS_DOMAIN_ID", "PYTHONPATH")}
    with (state / "log").open("wb") as log:
        hub = subprocess.Popen(command, cwd=state, env=environment, stdout=log, stderr=log, start_new_session=True)
        try:
            _wait(hub, f"{url}/hub/api/", state / "log")
            yield url
        finally:
            hub.terminate()  # it stops its users' servers and the proxy
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
    with_ports = [socket.socket() for _ in range(count)]
    for one in with_ports:
        one.bind(("127.0.0.1", 0))
    ports = [int(one.getsockname()[1]) for one in with_ports]
    for one in with_ports:
        one.close()
    return ports


def _run(folder: Path, *command: str) -> None:
    bin_folder = str(Path(sys.executable).parent)
    environment = {**os.environ, "PATH": os.pathsep.join([bin_folder, os.environ.get("PATH", os.defpath)])}
    done = subprocess.run(command, cwd=folder, env=environment, check=False)
    if done.returncode != 0:
        raise UsageError(f"{' '.join(command)} ended with {done.returncode}: its lines above say why")
