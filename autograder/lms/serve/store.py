"""The hand-ins on disk. Each method is one transaction, and durable when it returns.

The answers and the queue are one SQLite file; the results have a folder beside it for each number. No name of a
student's is a path. Only one process can have it open.
"""

from __future__ import annotations

import os
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

from autograder.exceptions import UsageError
from autograder.lms.serve.hand_in import HandIn, Mark
from autograder.lms.serve.queue import Waiting
from autograder.result.model import Status

FILE = "hand-ins.sqlite3"
GRADINGS = "gradings"
VERSION = 1
PATIENCE = 10.0  # s for a process to end that was killed just now
_TABLES = (
    """CREATE TABLE hand_in (
        number INTEGER PRIMARY KEY AUTOINCREMENT,
        student TEXT NOT NULL,
        assignment TEXT NOT NULL,
        key TEXT NOT NULL,      -- the student's own name for it: the same key again is the same hand-in
        at TEXT NOT NULL,       -- ISO 8601 with its offset
        turn INTEGER,           -- the count of gradings when its own began, NULL before
        status TEXT,            -- NULL until it is graded
        points REAL,
        max_points REAL,
        UNIQUE (student, key)
    )""",
    "CREATE TABLE answer (number INTEGER PRIMARY KEY REFERENCES hand_in, data BLOB NOT NULL)",
    "CREATE INDEX waiting ON hand_in (number) WHERE status IS NULL",
    "CREATE INDEX own ON hand_in (student, assignment)",
)
_COLUMNS = "number, student, assignment, at, status, points, max_points"


class Store:
    """The hand-ins in a private folder, which is created if it does not exist."""

    def __init__(self, folder: Path) -> None:
        """Open the store. Raises UsageError if it cannot be opened, or another process has it."""
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            (folder / GRADINGS).mkdir(exist_ok=True)
            self._gradings = folder / GRADINGS
            self._base = sqlite3.connect(folder / FILE, timeout=PATIENCE, isolation_level=None)
            self._base.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._base.execute("PRAGMA journal_mode = WAL")
            self._base.execute("PRAGMA synchronous = FULL")
            with self._transaction():
                self._begin()
        except (OSError, sqlite3.Error) as error:
            raise UsageError(
                f"{folder}: the hand-ins cannot be opened ({error}): name a folder of your own that no other "
                "`autograder serve` works on"
            ) from None

    def _begin(self) -> None:
        (version,) = self._base.execute("PRAGMA user_version").fetchone()
        if version == 0:
            for statement in _TABLES:
                self._base.execute(statement)
            self._base.execute(f"PRAGMA user_version = {VERSION}")
        elif version != VERSION:
            raise sqlite3.DatabaseError(f"they are of version {version}, and this is version {VERSION}")
        self._base.execute("UPDATE hand_in SET turn = NULL WHERE status IS NULL")  # interrupted: it is done again

    def close(self) -> None:
        """Close the store; another process can open it then."""
        self._base.close()

    def receive(self, student: str, assignment: str, key: str, answer: bytes, at: datetime) -> HandIn:
        """Keep an answer, and return its hand-in. A repeated key of a student returns the existing one."""
        with self._transaction():
            row = (student, assignment, key, at.isoformat())
            cursor = self._base.execute(
                "INSERT INTO hand_in (student, assignment, key, at) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING", row
            )
            if cursor.rowcount:
                self._base.execute("INSERT INTO answer VALUES (?, ?)", (cursor.lastrowid, answer))
        hand_in = self.with_key(student, key)
        assert hand_in is not None
        return hand_in

    def begin(self, number: int) -> bytes:
        """Note that the turn of a hand-in has come, and return the answer."""
        with self._transaction():
            self._base.execute(
                "UPDATE hand_in SET turn = 1 + (SELECT COALESCE(MAX(turn), 0) FROM hand_in) WHERE number = ?", (number,)
            )
        (data,) = self._base.execute("SELECT data FROM answer WHERE number = ?", (number,)).fetchone()
        return bytes(data)

    def finish(self, number: int, mark: Mark) -> None:
        """Note the mark of a hand-in, whose folder is complete."""
        _flush(self.folder(number))
        with self._transaction():
            self._base.execute(
                "UPDATE hand_in SET status = ?, points = ?, max_points = ? WHERE number = ?",
                (mark.status.value, mark.points, mark.max_points, number),
            )

    def grade_again(self, assignment: str) -> None:
        """Let all graded hand-ins of an assignment wait again. They have no marks until then."""
        with self._transaction():
            self._base.execute(
                "UPDATE hand_in SET turn = NULL, status = NULL, points = NULL, max_points = NULL WHERE assignment = ? "
                "AND status NOT NULL",
                (assignment,),
            )

    def folder(self, number: int) -> Path:
        """Return the folder of a hand-in's result."""
        return self._gradings / f"{number:06}"

    def waiting(self) -> list[Waiting]:
        """Return the ungraded hand-ins in the order of their arrival."""
        rows = self._base.execute("SELECT number, student FROM hand_in WHERE status IS NULL ORDER BY number")
        return [Waiting(*row) for row in rows]

    def turns(self) -> dict[str, int]:
        """Return when each student had the last turn, as a count of turns."""
        return dict(self._base.execute("SELECT student, MAX(turn) FROM hand_in WHERE turn NOT NULL GROUP BY student"))

    def with_number(self, number: int) -> HandIn | None:
        """Return the hand-in of a number."""
        return next(iter(self._select("number = ?", number)), None)

    def with_key(self, student: str, key: str) -> HandIn | None:
        """Return the hand-in to which a student gave this key."""
        return next(iter(self._select("student = ? AND key = ?", student, key)), None)

    def of_student(self, student: str) -> list[HandIn]:
        """Return a student's hand-ins, in the order in which they came."""
        return self._select("student = ?", student)

    def of_assignment(self, assignment: str) -> list[HandIn]:
        """Return all hand-ins of an assignment, in the order in which they came."""
        return self._select("assignment = ?", assignment)

    def _select(self, condition: str, *values: str | int) -> list[HandIn]:
        rows = self._base.execute(f"SELECT {_COLUMNS} FROM hand_in WHERE {condition} ORDER BY number", values)
        return [_hand_in(row) for row in rows]

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._base.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            self._base.execute("ROLLBACK")
            raise
        self._base.execute("COMMIT")


def _hand_in(row: Sequence[object]) -> HandIn:
    number, student, assignment, at, status, points, max_points = row
    mark = None if status is None else Mark(Status(status), float(str(points)), float(str(max_points)))
    return HandIn(int(str(number)), str(student), str(assignment), datetime.fromisoformat(str(at)), mark)


def _flush(folder: Path) -> None:
    """Write the files of a folder, and their names, to the disk, as SQLite does its own."""
    for path in (*folder.iterdir(), folder, folder.parent):
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
