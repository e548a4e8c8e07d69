"""The Python tutorials of ROS 2 Jazzy run here as printed: commands, code and expected output.

ROS2_DOCUMENTATION_SOURCE names a clone of github.com/ros2/ros2_documentation, branch jazzy; `make tutorials` makes one.
`tutorials/pages.yaml` says what a reader does on each page; commands, code and changes of files are the page's own.
Turtlesim and demo_nodes_cpp, which are written in C++ and have no wheels, have a stand-in in `tutorials/packages`.
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

    def code(self, language: str, words: str) -> str:
        """Return the page's first block of a language that has the words."""
        blocks = (textwrap.dedent(block) for _, name, block in BLOCK.findall(self.text) if name.lower() == language)
        return next(block.strip() + "\n" for block in blocks if words in block)

    def expect(self, line: str) -> None:
        """Fail unless the page prints the line; a comma at its end is free."""
        printed = {other.strip().rstrip(",") for other in self.text.splitlines()}
        assert line.strip().rstrip(",") in printed, f"the page does not print: {line}"


@dataclass
class Program:
    """A command that keeps running in a terminal; a thread reads its output."""

    process: subprocess.Popen[str]
    lines: queue.SimpleQueue[str | None] = field(default_factory=queue.SimpleQueue)
    seen: list[str] = field(default_factory=list)

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
            assert line is not None, f"it ended without {missing}:\n{''.join(self.seen)}"
            self.seen.append(line)
            missing = {text for text in missing if text not in line}

    def stop(self, texts: list[str]) -> None:
        """Press Ctrl-C: a terminal sends it to all processes of the command."""
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

    def call(self, command: str, place: str = ".") -> dict[str, Any]:
        """Return the arguments of a process that runs a command in a new terminal where all workspaces are sourced."""
        sources = (f"! test -f {root}/install/setup.bash || . {root}/install/setup.bash" for root in self.roots)
        words = "; ".join([*sources, f"cd {self.folder / place}", command])
        variables = {**os.environ, "ROS_DOMAIN_ID": str(self.domain), "PYTHONUNBUFFERED": "1", "USER": "reader"}
        del variables["RCUTILS_LOGGING_USE_STDOUT"]  # the tests' own; a terminal has none
        return {
            "args": [sys.executable, "-m", "autograder", "ros", "bash", "-c", words],
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
        """Do one step of a page."""
        match step:
            case {"run": command}:
                page.expect(command)
                done = subprocess.run(**self.call(command, step.get("in", ".")), timeout=PATIENCE)
                assert done.returncode == 0, done.stdout
                assert [text for text in step.get("says", ()) if text not in done.stdout] == [], done.stdout
                assert [text for text in step.get("silent", ()) if text in done.stdout] == [], done.stdout
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
        (where,) = {"before", "behind"} & set(step)
        place = step[where]
        added = "\n".join([*lines, place] if where == "before" else [place, *lines])
        text = path.read_text()
        assert text.count(place) == 1, f"{path} has no one place {place!r}:\n{text}"
        path.write_text(text.replace(place, added))


@pytest.fixture(scope="module")
def turtles(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build the packages of the tutorials that have no wheel."""
    folder = tmp_path_factory.mktemp("turtles")
    (folder / "src").symlink_to(HERE / "packages")
    built = subprocess.run(**Reader(folder, folder, 0).call("colcon build"), timeout=PATIENCE)
    assert built.returncode == 0, built.stdout
    return folder


@pytest.fixture
def reader(turtles: Path, tmp_path: Path, ros_domain: int) -> Iterator[Reader]:
    """A new workspace; commands still running at the end get Ctrl-C, and must end."""
    (tmp_path / "src").mkdir()
    reader = Reader(tmp_path, turtles, ros_domain)
    yield reader
    for program in reader.programs.values():
        program.stop([])


def text(page: Step) -> Page:
    """Return a page as the documentation has it."""
    return Page((Path(os.environ[SOURCE]) / "source/Tutorials" / f"{page['page']}.rst").read_text())


@pytest.mark.promise(
    "`make tutorials` executes the Python tutorials in Jazzy's documentation",
    '`make tutorials PYTEST_ARGS="-k NAME"` executes one of them',
    "It takes commands, code and file changes from the pages",
)
@pytest.mark.nightly
@pytest.mark.skipif(not os.environ.get(SOURCE), reason=f"{SOURCE} names no clone")
@pytest.mark.timeout(4 * PATIENCE)
@pytest.mark.parametrize("name", RUN)
def test_a_tutorial_runs_as_printed(name: str, reader: Reader) -> None:
    page = RUN[name]
    for earlier in page.get("after", ()):
        for step in RUN[earlier]["make"]:
            reader.do(text(RUN[earlier]), step)
    for step in [*page.get("make", ()), *page["do"]]:
        reader.do(text(page), step)
