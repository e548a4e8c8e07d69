"""Writes attacks: adds a payload to the reference, or to a mutant whose failures are known."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path

from autograder.author.verification.mutants import Mutant, mutants, write_mutant, write_reference
from autograder.author.verification.verdicts import Attack
from autograder.suite import suites

MIN_ID_LENGTH = 14  # characters; a shorter check id may also be the name of something else
Write = Callable[[Path], None]

# Spins each node in its own thread, so that the program cannot be stepped and runs in real time.
FORCE_REAL_TIME = """
import threading as _threading
import rclpy as _rclpy
def _spin_beside(*arguments, _spin=_rclpy.spin):
    thread = _threading.Thread(target=_spin, args=arguments, daemon=True)
    thread.start()
    while thread.is_alive():
        thread.join(0.1)
_rclpy.spin = _spin_beside
"""

# `_is_told()` returns whether anything around the program names a hidden check or the assignment.
LOOK_FOR_NAMES = """
import glob as _glob, os as _os, sys as _sys, threading as _threading
def _is_told(names={names!r}):
    files = ["/proc/self/cgroup", "/proc/self/mountinfo", *_glob.glob("/proc/[0-9]*/cmdline"), "/proc/self/environ"]
    words = [str(_os.environ), str(_sys.argv), str(list(_sys.modules)), _os.getcwd(), *_os.uname()]
    words += [thread.name for thread in _threading.enumerate()]
    for file in files:
        try:
            words.append(open(file, errors="replace").read())
        except OSError:
            pass
    return any(name in text for name in names for text in words)
"""


@dataclass(frozen=True)
class Chapter:
    """A chapter whose reference and mutants are the basis of attacks."""

    assignment: str

    @property
    def checks(self) -> frozenset[str]:
        """The ids of all hidden checks."""
        return frozenset(check.id for check in suites.hidden(self.assignment).checks)

    def mutant(self, name: str) -> Mutant:
        """Return the mutant with this id."""
        return next(mutant for mutant in mutants(self.assignment) if mutant.id == name)

    def write(
        self,
        base: str | None = None,
        *,
        heads: Mapping[str, str] = {},
        swaps: Mapping[str, tuple[str, str]] = {},
        files: Mapping[str, str] = {},
    ) -> Write:
        """Return a function that writes a source tree with payloads. Paths are relative to its `src`.

        Args:
            base: the id of the mutant to start from; None to start from the reference.
            heads: for each file, the text to insert at its start.
            swaps: for each file, the text to replace and its replacement.
            files: the text of each additional file.
        """

        def write(folder: Path) -> None:
            sources = suites.hidden(self.assignment).sources
            if base is None:
                write_reference(sources, folder)
            else:
                write_mutant(self.mutant(base), sources, folder)
            home = folder / "src"
            for name, text in files.items():
                (home / name).parent.mkdir(parents=True, exist_ok=True)
                (home / name).write_text(text)
            for name, (find, replacement) in swaps.items():
                text = (home / name).read_text()
                assert text.count(find) == 1, find
                (home / name).write_text(text.replace(find, replacement))
            for name, head in heads.items():
                (home / name).write_text(f"{head}\n{(home / name).read_text()}")

        return write

    def evasions(self, manner: str, mistake: str, base: str, file: str, swap: tuple[str, str]) -> tuple[Attack, ...]:
        """Return two attacks that try to hide a mistake: one runs in real time, one behaves well if it detects a check.

        Args:
            manner: how the program behaves; the ids of the attacks begin with it.
            mistake: a description of the mistake.
            base: the id of the mutant that makes the mistake.
            file: the file that gets the payloads.
            swap: a part of this file in the reference, and a replacement. The replacement makes the mistake only if
                `_is_told()` is false, that is, if nothing around the program names the hidden checks.
        """
        names = (self.assignment, "hidden", *sorted(name for name in self.checks if len(name) > MIN_ID_LENGTH))
        fails = self.mutant(base).fails
        return (
            Attack(
                f"{manner} in real time",
                f"{mistake}, in its own thread, so that it runs in real time",
                self.write(base, heads={file: FORCE_REAL_TIME}),
                fails,
            ),
            Attack(
                f"{manner} unless told",
                f"{mistake}, unless its environment names the hidden checks",
                self.write(heads={file: LOOK_FOR_NAMES.format(names=names)}, swaps={file: swap}),
                fails,
            ),
        )
