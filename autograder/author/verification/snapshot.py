"""The recorded failures of each named mutant: every check that it did not pass when it was last recorded.

`mutants.yaml` says for which check somebody wrote a mutant. What else it fails follows from the suite, so no person
keeps that list: `autograder verify --record` writes it, and a reviewer reads the difference.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import yaml

from autograder.result.model import write_atomically
from autograder.suite import suites

HEAD = """# All checks that each mutant of mutants.yaml does not pass. Do not edit: this command writes it.
#     autograder verify --assignment {assignment} --record
"""
ALL = "all"
WIDTH = 118  # characters in a line


def snapshot_file(assignment: str) -> Path:
    """Return the file that holds an assignment's recorded failures."""
    return suites.hidden(assignment).folder / "mutants.snapshot.yaml"


def recorded(assignment: str) -> dict[str, frozenset[str]]:
    """Return the ids of the checks that each recorded mutant fails, by the mutant's id.

    A check that the suite no longer has is left out.
    """
    path = snapshot_file(assignment)
    known = frozenset(check.id for check in suites.hidden(assignment).checks)
    loader = getattr(yaml, "CSafeLoader", yaml.SafeLoader)
    rows = yaml.load(path.read_text(encoding="utf-8"), loader) or {} if path.is_file() else {}
    return {name: known if failed == ALL else known & frozenset(failed) for name, failed in rows.items()}


def write(assignment: str, failures: Mapping[str, frozenset[str]]) -> None:
    """Write an assignment's recorded failures, in the order of `failures` and of the suite."""
    order = [check.id for check in suites.hidden(assignment).checks]
    rows: dict[str, object] = {
        name: ALL if len(failed) == len(order) else [check for check in order if check in failed]
        for name, failed in failures.items()
    }
    text = yaml.dump(rows, default_flow_style=None, width=WIDTH, sort_keys=False)
    write_atomically(snapshot_file(assignment), (HEAD.format(assignment=assignment) + text).encode())
