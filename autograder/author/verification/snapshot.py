"""Snapshots of the named mutants: the checks that each mutant fails, and its diagnosis.

`mutants.yaml` names the check for which a mutant was written. `autograder verify --record` writes all checks that the
mutant fails, and its diagnosis. So nobody has to maintain these lists, and reviewers see every change in the diff.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from autograder.author.course.yaml_files import load_yaml
from autograder.diagnosis import Kind
from autograder.result.model import write_atomically
from autograder.suite import suites

HEAD = """# All checks that each mutant of mutants.yaml does not pass, and its diagnosis where that is not "ok".
# Do not edit: this command writes it.
#     autograder verify --assignment {assignment} --record
"""
ALL = "all"
WIDTH = 118  # the longest line of a snapshot, in characters


@dataclass(frozen=True)
class Record:
    """The record of a mutant.

    Attributes:
        fails: the ids of all checks that the mutant does not pass; empty if nothing is recorded.
        diagnosis: the diagnosis of how the programs were built and started.
    """

    fails: frozenset[str] = frozenset()
    diagnosis: Kind = Kind.OK


def snapshot_file(assignment: str) -> Path:
    """Return the path of the file with an assignment's records."""
    return suites.hidden(assignment).folder / "mutants.snapshot.yaml"


def recorded(assignment: str) -> dict[str, Record]:
    """Return the record of each mutant, by the mutant's id.

    Checks that the suite no longer has are omitted. Raises CourseError if the file is not YAML, or violates its schema.
    """
    path = snapshot_file(assignment)
    check_ids = frozenset(check.id for check in suites.hidden(assignment).checks)
    rows = (load_yaml(path) if path.is_file() else None) or {}
    return {name: _parse_record(row, check_ids) for name, row in rows.items()}


def write(assignment: str, records: Mapping[str, Record]) -> None:
    """Write an assignment's records in the order of `records`, and the checks of each in the order of the suite."""
    order = [check.id for check in suites.hidden(assignment).checks]
    rows = {name: _format_record(record, order) for name, record in records.items()}
    text = yaml.dump(rows, default_flow_style=None, width=WIDTH, sort_keys=False)
    write_atomically(snapshot_file(assignment), (HEAD.format(assignment=assignment) + text).encode())


def _parse_record(row: Any, check_ids: frozenset[str]) -> Record:
    """Parse a record: `all`, a list of checks, or a mapping of `fails` (one of these two) and `diagnosis`."""
    fails, diagnosis = (row["fails"], row["diagnosis"]) if isinstance(row, dict) else (row, Kind.OK)
    return Record(check_ids if fails == ALL else check_ids & frozenset(fails), Kind(diagnosis))


def _format_record(record: Record, order: list[str]) -> object:
    fails: object = ALL if len(record.fails) == len(order) else [check for check in order if check in record.fails]
    return fails if record.diagnosis is Kind.OK else {"diagnosis": record.diagnosis.value, "fails": fails}
