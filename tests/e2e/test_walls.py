"""A compromised worker, which can run any code, harms only the result of its own submission."""

from __future__ import annotations

import json
import os
import shutil
import sys
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.building import bundle_server
from autograder.exceptions import StudentError
from autograder.grade import grade_submission, isolated_reader, own_sandbox
from autograder.grade.job import Job
from autograder.result.model import Result, Status
from autograder.run.sandbox import Isolation
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.trees import read_tree
from autograder.submission import intake

ASSIGNMENT = "02_nodes"
SECRET = "a secret of bob's"
BEGIN = """
import ctypes, json, os, sys
from multiprocessing.connection import Connection
from pathlib import Path
from autograder.grade.job import Job
job, line = Job.from_json(sys.argv[1]), Connection(int(sys.argv[2]))
def out(*what): print("OUT", *what, flush=True)
"""
LOOK = """
for path in SECRETS:
    if os.path.exists(path): out("sees", path)
for folder, _, names in os.walk("/"):
    if folder.startswith(("/proc", "/usr", sys.prefix)): continue
    for name in names:
        try:
            if SECRET[:6].encode() + SECRET[6:].encode() in open(f"{folder}/{name}", "rb").read(): out("reads", name)
        except OSError: pass
others = [pid for pid in os.listdir("/proc") if pid.isdigit() and int(pid) != os.getpid()]
if others: out("sees processes", others)
if any(name in os.environ for name in ("A_KEY", "SSH_AUTH_SOCK")): out("sees the environment")
if os.getuid() == 0 or "0" in open("/proc/self/uid_map").read().split()[:2]: out("is root")
if int(open("/proc/self/status").read().split("CapEff:")[1].split()[0], 16): out("has rights")
"""
WRITE = """
os.environ["PATH"] = "/usr/bin:/bin"
own = {str(job.scratch), "/tmp", "/dev/shm", "/dev/pts", "/proc", *GROUPS}
own |= {f"/dev/{name}" for name in ("null", "zero", "full", "random", "urandom", "tty", "console", "ptmx")}
pending = ["/"]
while pending:
    folder = pending.pop()
    if os.access(folder, os.W_OK): out("may write to", folder)
    try: entries = list(os.scandir(folder))
    except PermissionError: continue
    for entry in entries:
        if entry.path in own or entry.is_symlink(): continue
        if entry.is_dir(): pending.append(entry.path)
        elif not folder.startswith("/usr") and os.access(entry.path, os.W_OK): out("may write to", entry.path)
for folder, _, names in os.walk("/proc/sys"):
    for name in {*names} - {"ns_last_pid"}:  # belongs to the worker sandbox's own process ids
        if os.access(f"{folder}/{name}", os.W_OK) and "/sys/user" not in folder: out("may write to", folder, name)
for path in Path("/proc/sys/user").iterdir():
    try:
        value = path.read_text()
        path.write_text(value)
        out("wrote", path)
    except OSError: pass
"""
FORGE = """
from autograder.run.sandbox.messages import send_message, send_tree
from autograder.run.sandbox.trees import Entry
send_message(line, {"do": "result"})
answer = json.loads(RESULT)
answer["student"] = "bob"
data = json.dumps(answer).encode()
send_tree(line, {Entry("result.json", "file", False, len(data)): data})
"""
INVALID = """
line.send_bytes(b"[" * 100_000)
"""
FLOOD = """
while True: line.send_bytes(bytes(3 << 20))
"""
CLIMB = """
from autograder.run.sandbox.messages import send_message, send_tree
from autograder.run.sandbox.trees import Entry
send_message(line, {"do": "result"})
send_tree(line, {Entry("../bob/result.json", "file", False, 4): b"mine"})
"""


@pytest.fixture
def classroom(tmp_path: Path) -> Path:
    """Submissions of two students; bob has a result."""
    for student in ("alice", "bob"):
        (tmp_path / student / "src" / "pkg").mkdir(parents=True)
        (tmp_path / student / "src" / "pkg" / "package.xml").write_text(f"<package>{SECRET}</package>")
    (tmp_path / "alice" / "src" / "pkg" / "package.xml").write_text("<package/>")
    grade(tmp_path, "bob")
    return tmp_path


def grade(folder: Path, student: str) -> Result:
    out = folder / "results" / student
    return grade_submission(Job(folder / student, ASSIGNMENT, student, 1, out, seconds=60.0))


def compromise_worker(monkeypatch: pytest.MonkeyPatch, code: str, **names: object) -> None:
    constants = "".join(f"{name} = {value!r}\n" for name, value in names.items())
    program = f"{BEGIN}{constants}{code}"
    monkeypatch.setattr(
        own_sandbox, "_worker_command", lambda job, line: [sys.executable, "-c", program, job.to_json(), str(line)]
    )


def test_a_compromised_worker_sees_only_its_submission_and_its_chapter(
    classroom: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("A_KEY", "secret")
    other_folders = [folder for folder in course_paths.check_folders() if folder.name != f"ch{ASSIGNMENT}"]
    private_parts = ("hidden", "mutants.yaml", "variants", "attacks.py")
    hidden = [folder / part for folder in other_folders for part in private_parts]
    own_hidden = [course_paths.CHECKS / f"ch{ASSIGNMENT}" / name for name in ("mutants.yaml", "variants", "attacks.py")]
    chapters = [folder for folder in course_paths.CHAPTERS.iterdir() if folder.name != ASSIGNMENT]
    homes = ["/root", "/home", "/var", "/run", "/etc/passwd", "/etc/shadow", Path.home() / ".cache"]
    secrets = [
        *hidden,
        *own_hidden,
        *chapters,
        *homes,
        course_paths.SOLUTIONS,
        course_paths.ROOT / "tests",
        course_paths.ROOT / ".git",
    ]
    secrets += [classroom / "bob", classroom / "results", classroom / "alice" / ".." / "bob"]
    # Python may be installed in one of the home folders.
    paths = [path for path in map(str, secrets) if not str(sys.prefix).startswith(path)]
    compromise_worker(monkeypatch, LOOK, SECRETS=paths, SECRET=SECRET)
    assert grade(classroom, "alice").status is Status.NOT_GRADED
    log = (classroom / "results" / "alice" / "grader.log").read_text()
    assert "OUT" not in log
    assert "Traceback" not in log


def test_a_compromised_worker_can_write_only_to_its_scratch_folder(
    classroom: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    compromise_worker(monkeypatch, WRITE, GROUPS=["/sys/fs/cgroup"])
    before = (classroom / "results" / "bob" / "result.json").read_bytes()
    assert grade(classroom, "alice").status is Status.NOT_GRADED
    log = (classroom / "results" / "alice" / "grader.log").read_text()
    assert "OUT" not in log
    assert "Traceback" not in log
    assert (classroom / "results" / "bob" / "result.json").read_bytes() == before


@pytest.mark.parametrize(
    ("code", "logged"),
    [
        pytest.param(FORGE, "a worker graded", id="the result of another student"),
        pytest.param(INVALID, "a message is not JSON", id="not a message"),
        pytest.param(FLOOD, "a message is not JSON", id="a flood"),
        pytest.param(CLIMB, "paths that lead out of it", id="a path that leads out"),
    ],
)
def test_the_reply_of_a_compromised_worker_harms_no_other_student(
    classroom: Path, monkeypatch: pytest.MonkeyPatch, code: str, logged: str
) -> None:
    stored = classroom / "results" / "bob" / "result.json"
    before = stored.read_bytes()
    compromise_worker(monkeypatch, code, RESULT=json.dumps(json.loads(before)))
    result = grade(classroom, "alice")
    assert (result.status, result.student, result.score) == (Status.NOT_GRADED, "alice", 0.0)
    assert logged in (classroom / "results" / "alice" / "grader.log").read_text()
    assert stored.read_bytes() == before
    assert sorted(os.listdir(classroom / "results")) == ["alice", "bob"]


PACKAGE = """<package format="3"><name>forged_msgs</name><version>0.0.1</version><description>x</description>
<maintainer email="a@b.c">a</maintainer><license>MIT</license><buildtool_depend>ament_cmake</buildtool_depend>
<member_of_group>rosidl_interface_packages</member_of_group><export><build_type>ament_cmake</build_type></export>
</package>"""
CMAKE = "cmake_minimum_required(VERSION 3.8)\nproject(forged_msgs NONE)\ninstall(FILES package.xml DESTINATION share)\n"
REQUEST_BUILD = """
from autograder.building import bundle_server
from autograder.run.sandbox.limits import SOURCES
from autograder.run.sandbox.trees import read_tree
for name, text in FILES.items():
    path = job.scratch / "mine" / "forged_msgs" / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)
bundle_server.request_build(line, read_tree(job.scratch / "mine", SOURCES), job.scratch / "built")
print("BUILT", [str(path.relative_to(job.scratch)) for path in (job.scratch / "built").rglob("package.xml")])
"""


def test_shared_builds_come_from_an_untouched_worker_and_match_their_sources(
    classroom: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("XDG_CACHE_HOME", str(classroom / "cache"))
    files = {"package.xml": PACKAGE, "CMakeLists.txt": CMAKE}
    compromise_worker(monkeypatch, REQUEST_BUILD, FILES=files)
    grade(classroom, "alice")
    log = (classroom / "results" / "alice" / "grader.log").read_text()
    assert "BUILT ['built/install/forged_msgs/share/package.xml']" in log
    package = classroom / "mine" / "forged_msgs"
    package.mkdir(parents=True)
    for name, text in files.items():
        (package / name).write_text(text)
    cache = classroom / "cache" / "autograder" / bundle_server.CACHE
    cached = {path.name for path in cache.iterdir() if path.is_dir()}
    assert cached == {bundle_server.key(read_tree(package.parent, SOURCES))}


@pytest.mark.skipif(
    os.geteuid() != 0 or not shutil.which("setpriv"), reason="only root can run a command as another user"
)
def test_root_grades_files_that_only_root_can_read(classroom: Path) -> None:
    for path in (classroom / "alice", *(classroom / "alice").rglob("*")):
        path.chmod(0o700 if path.is_dir() else 0o600)
    result = grade(classroom, "alice")
    assert (result.status, result.isolation) == (Status.GRADED, Isolation.BUBBLEWRAP.value)
    assert "is not a package's name" in result.diagnosis.sentence


@pytest.mark.skipif(
    os.geteuid() != 0 or not shutil.which("setpriv"), reason="only root can run a command as another user"
)
def test_root_reads_no_submission_for_a_preview_or_a_comparison(
    classroom: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (classroom / "alice" / "src" / "pkg" / "node.py").write_text("x = '\u2028'")
    (classroom / "carol.zip").write_bytes(b"not a zip")
    (classroom / "alice").chmod(0o700)

    def read(*_: object) -> None:
        pytest.fail("root reads a submission")

    monkeypatch.setattr(intake, "read_submission", read)
    preview = isolated_reader.read_preview(classroom / "alice", ASSIGNMENT, Isolation.BUBBLEWRAP)
    assert (preview.files, preview.unused) == (2, ())
    assert isolated_reader.read_code(classroom / "alice", ASSIGNMENT, Isolation.BUBBLEWRAP) == "# pkg/node.py\nx = '\n'"
    with pytest.raises(StudentError, match=r"carol.zip is not a folder"):
        isolated_reader.read_preview(classroom / "carol.zip", ASSIGNMENT, Isolation.BUBBLEWRAP)


REPORT_RIGHTS = """
out("is", os.getuid() in range(47000, 48000), os.getgid() == os.getuid(), os.getgroups())
out("rights", int(open("/proc/self/status").read().split("CapEff:")[1].split()[0], 16))
out("reads", (job.path / "src" / "pkg" / "package.xml").read_text())
(job.out / "mine").parent.mkdir()
(job.out / "mine").write_text("")
try: Path(STORED).write_text("mine")
except OSError: out("is refused")
"""


@pytest.mark.skipif(
    os.geteuid() != 0 or not shutil.which("setpriv"), reason="only root can run a command as another user"
)
def test_root_privileges_are_also_dropped_without_namespaces(classroom: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    for path in (classroom / "alice", *(classroom / "alice").rglob("*")):
        path.chmod(0o700 if path.is_dir() else 0o600)
    stored = classroom / "results" / "bob" / "result.json"
    before = stored.read_bytes()
    compromise_worker(monkeypatch, REPORT_RIGHTS, STORED=str(stored))
    out = classroom / "results" / "alice"
    grade_submission(Job(classroom / "alice", ASSIGNMENT, "alice", 1, out, Isolation.PROCESS))
    log = (out / "grader.log").read_text()
    assert "OUT is True True []" in log
    assert "OUT rights 0" in log
    assert "OUT reads <package/>" in log
    assert "OUT is refused" in log
    assert "Traceback" not in log
    assert stored.read_bytes() == before
