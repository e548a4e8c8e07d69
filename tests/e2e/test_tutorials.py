"""The Python tutorials of ROS 2 Jazzy run here as printed: commands, code and expected output.

ROS2_DOCUMENTATION_SOURCE is the path of a clone of github.com/ros2/ros2_documentation, branch jazzy, which `make
tutorials` creates. `tutorials/pages.yaml` lists what a reader does on each page; commands, code and changes of files
come from the page. `tutorials/packages` has stand-ins for turtlesim and demo_nodes_cpp, which are written in C++ and
have no wheels.
"""

from __future__ import annotations

import os
import queue
import re
import signal
import subprocess
import sys
import textwrap
import threading
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest
import yaml

from autograder.course_paths import ROOT

SOURCE = "ROS2_DOCUMENTATION_SOURCE"
HERE = Path(__file__).parent / "tutorials"
PAGES: list[dict[str, Any]] = yaml.safe_load((HERE / "pages.yaml").read_text())
RUN = {page["name"]: page for page in PAGES if "missing" not in page}
PATIENCE = 300.0
BLOCK = re.compile(r"^( *)\.\. code-block:: *(\w+)\n((?:\1 +\S.*\n| *\n)+)", re.MULTILINE)

Step = dict[str, Any]


@dataclass(frozen=True)
class Page:
    """The text of a page."""

    text: str

    def code(self, language: str, text: str) -> str:
        """Return the page's first block of code in a language that contains a text."""
        blocks = (textwrap.dedent(block) for _, name, block in BLOCK.findall(self.text) if name.lower() == language)
        return next(block.strip() + "\n" for block in blocks if text in block)

    def expect(self, line: str) -> None:
        """Fail unless the page prints the line, with or without a comma at its end."""
        printed = {other.strip().rstrip(",") for other in self.text.splitlines()}
        assert line.strip().rstrip(",") in printed, f"the page does not print: {line}"


@dataclass
class Program:
    """A command that keeps running in a terminal; a thread reads its output."""

    process: subprocess.Popen[str]
    lines: queue.SimpleQueue[str | None] = field(default_factory=queue.SimpleQueue)
    printed: list[str] = field(default_factory=list)

    def __post_init__(self) -> None:
        self.thread = threading.Thread(target=self._read)
        self.thread.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout:
            for line in self.process.stdout:
                self.lines.put(line)
        self.lines.put(None)

    def expect(self, texts: list[str]) -> None:
        """Wait until the program has printed each of the texts, in any order."""
        missing = set(texts)
        while missing:
            line = self.lines.get(timeout=PATIENCE)
            assert line is not None, f"the program ended without {missing}:\n{''.join(self.printed)}"
            self.printed.append(line)
            missing = {text for text in missing if text not in line}

    def stop(self, texts: list[str]) -> None:
        """Send SIGINT to all processes of the command, as Ctrl-C in a terminal does; wait for the texts and the end."""
        with suppress(ProcessLookupError):
            os.killpg(self.process.pid, signal.SIGINT)
        self.expect(texts)
        self.process.wait(PATIENCE)
        self.thread.join()


@dataclass
class Reader:
    """A reader who follows a page in a workspace."""

    folder: Path
    turtles: Path
    domain: int
    programs: dict[str, Program] = field(default_factory=dict)

    def call(self, command: str, folder: str = ".") -> dict[str, Any]:
        """Return the arguments of a process that runs a command in a new terminal where all workspaces are sourced."""
        sources = (f"! test -f {root}/install/setup.bash || . {root}/install/setup.bash" for root in self.roots)
        script = "; ".join([*sources, f"cd {self.folder / folder}", command])
        variables = {**os.environ, "ROS_DOMAIN_ID": str(self.domain), "PYTHONUNBUFFERED": "1", "USER": "reader"}
        del variables["RCUTILS_LOGGING_USE_STDOUT"]  # set by the tests, but not in a terminal
        return {
            "args": [sys.executable, "-m", "autograder", "ros", "bash", "-c", script],
            "env": variables,
            "stdout": subprocess.PIPE,
            "stderr": subprocess.STDOUT,
            "text": True,
        }

    @property
    def roots(self) -> tuple[Path, ...]:
        """The workspaces that are sourced, in this order."""
        return self.turtles, self.folder

    def do(self, page: Page, step: Step) -> None:
        """Execute a step of a page."""
        match step:
            case {"run": command}:
                page.expect(command)
                process = subprocess.run(**self.call(command, step.get("in", ".")), timeout=PATIENCE)
                assert process.returncode == 0, process.stdout
                assert [text for text in step.get("says", ()) if text not in process.stdout] == [], process.stdout
                assert [text for text in step.get("silent", ()) if text in process.stdout] == [], process.stdout
            case {"start": command}:
                page.expect(command)
                call = self.call(f"exec {command}", step.get("in", "."))
                self.programs[command] = Program(subprocess.Popen(**call, start_new_session=True))
                self.programs[command].expect(step.get("says", []))
            case {"later": command}:
                self.programs[command].expect(step["says"])
            case {"stop": command}:
                self.programs.pop(command).stop(step.get("says", []))
            case {"file": name}:
                (path := self.folder / name).parent.mkdir(exist_ok=True)
                path.write_text(page.code(step["code"], step["with"]))
            case {"edit": name}:
                self._edit(self.folder / name, page, step)
            case _:
                raise ValueError(f"pages.yaml: no such step: {step}")

    def _edit(self, path: Path, page: Page, step: Step) -> None:
        lines = step["lines"] if "lines" in step else page.code(step["code"], step["with"]).splitlines()
        for line in lines:
            page.expect(line)
        (side,) = {"before", "behind"} & set(step)
        anchor = step[side]
        added = "\n".join([*lines, anchor] if side == "before" else [anchor, *lines])
        text = path.read_text()
        assert text.count(anchor) == 1, f"{path} does not contain {anchor!r} exactly once:\n{text}"
        path.write_text(text.replace(anchor, added))


@pytest.fixture(scope="module")
def turtles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the packages that the tutorials need and that have no wheels; return their workspace."""
    folder = tmp_path_factory.mktemp("turtles")
    (folder / "src").symlink_to(HERE / "packages")
    process = subprocess.run(**Reader(folder, folder, 0).call("colcon build"), timeout=PATIENCE)
    assert process.returncode == 0, process.stdout
    return folder


@pytest.fixture
def reader(turtles: Path, tmp_path: Path, ros_domain: int) -> Iterator[Reader]:
    """A new workspace; commands still running at the end get Ctrl-C, and must end."""
    (tmp_path / "src").mkdir()
    reader = Reader(tmp_path, turtles, ros_domain)
    yield reader
    for program in reader.programs.values():
        program.stop([])


def read_page(page: Step) -> Page:
    """Read a page of the documentation."""
    return Page((Path(os.environ[SOURCE]) / "source/Tutorials" / f"{page['page']}.rst").read_text())


SMALL_PAGE = Page("""
Greetings
=========

.. code-block:: python

   def greeting(name):
       return 'Hello ' + name

Add the line

.. code-block:: python

   print(greeting('reader'))

.. code-block:: console

   python3 greeting.py
   Hello reader
""")


@pytest.mark.promise("It takes commands, code and file changes from the pages")
def test_a_reader_takes_code_changes_and_commands_from_a_page(tmp_path: Path, ros_domain: int) -> None:
    reader, line = Reader(tmp_path, tmp_path, ros_domain), "print(greeting('reader'))"
    reader.do(SMALL_PAGE, {"file": "greeting.py", "code": "python", "with": "def greeting(name):"})
    reader.do(SMALL_PAGE, {"edit": "greeting.py", "lines": [line], "behind": "return 'Hello ' + name"})
    assert (tmp_path / "greeting.py").read_text().endswith(f"name\n{line}\n")
    reader.do(SMALL_PAGE, {"run": "python3 greeting.py", "says": ["Hello reader"]})


@pytest.mark.parametrize(
    ("step", "message"),
    [
        ({"run": "python3 other.py"}, "the page does not print: python3 other.py"),
        ({"edit": "greeting.py", "lines": ["exit()"], "behind": "pass"}, r"the page does not print: exit\(\)"),
        ({"run": "Hello reader", "says": ["Hello"]}, "command not found"),
    ],
    ids=["a command", "a line", "an output"],
)
def test_a_step_that_differs_from_its_page_or_fails_is_an_error(
    tmp_path: Path, ros_domain: int, step: Step, message: str
) -> None:
    with pytest.raises(AssertionError, match=message):
        Reader(tmp_path, tmp_path, ros_domain).do(SMALL_PAGE, step)


@pytest.mark.promise('`make tutorials PYTEST_ARGS="-k NAME"` executes one of them')
def test_make_tutorials_executes_the_one_tutorial_that_is_named() -> None:
    name = "launch_file"
    settings = [f"{SOURCE}=/", f"BIN={Path(sys.executable).parent}", f"PYTEST_ARGS=-k {name}"]
    command = ["make", "--no-print-directory", "-n", "tutorials", *settings]
    recipe = subprocess.check_output(command, text=True, cwd=ROOT).splitlines()
    collect = {**os.environ, "PYTEST_ADDOPTS": "--collect-only -q"}
    collected = subprocess.check_output(["bash", "-c", recipe[-1]], env=collect, text=True, cwd=ROOT)
    assert re.findall(r"::(test_\S+)", collected) == [f"{test_a_tutorial_runs_as_printed.__name__}[{name}]"]
    assert [(one, other) for one in RUN for other in RUN if one in other and one != other] == []


@pytest.mark.promise(
    "`make tutorials` executes the Python tutorials in Jazzy's documentation",
    '`make tutorials PYTEST_ARGS="-k NAME"` executes one of them',
    "It takes commands, code and file changes from the pages",
)
@pytest.mark.nightly
@pytest.mark.skipif(not os.environ.get(SOURCE), reason=f"{SOURCE} is not set")
@pytest.mark.timeout(4 * PATIENCE)
@pytest.mark.parametrize("name", RUN)
def test_a_tutorial_runs_as_printed(name: str, reader: Reader) -> None:
    page = RUN[name]
    for earlier in page.get("after", ()):
        for step in RUN[earlier]["make"]:
            reader.do(read_page(RUN[earlier]), step)
    for step in [*page.get("make", ()), *page["do"]]:
        reader.do(read_page(page), step)
