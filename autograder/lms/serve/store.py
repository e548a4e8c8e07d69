"""The hand-ins on disk. Each method is one transaction, whose changes are durable when it returns.

One SQLite file contains the answers and the queue. Beside it, the result of each hand-in has a folder, which is named
after the hand-in's number, never after a student. Only one process can open the store.
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
from autograder.result.model import Status

FILE = "hand-ins.sqlite3"
GRADINGS = "gradings"
VERSION = 1
LOCK_TIMEOUT = 10.0  # s to wait for the file, which a killed process may still lock
_TABLES = (
    """CREATE TABLE hand_in (
        number INTEGER PRIMARY KEY AUTOINCREMENT,
        student TEXT NOT NULL,
        assignment TEXT NOT NULL,
        key TEXT NOT NULL,      -- chosen by the client: a repeated key is the same hand-in
        at TEXT NOT NULL,       -- ISO 8601 with its offset
        turn INTEGER,           -- the count of gradings when this one began, NULL before
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
    """The stored hand-ins, in a private folder that is created if necessary."""

    def __init__(self, folder: Path) -> None:
        """Open the store. Raises UsageError if it cannot be opened, or if another process uses it."""
        try:
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            (folder / GRADINGS).mkdir(exist_ok=True)
            self._gradings = folder / GRADINGS
            self._database = sqlite3.connect(folder / FILE, timeout=LOCK_TIMEOUT, isolation_level=None)
            self._database.execute("PRAGMA locking_mode = EXCLUSIVE")
            self._database.execute("PRAGMA journal_mode = WAL")
            self._database.execute("PRAGMA synchronous = FULL")
            with self._transaction():
                self._prepare_tables()
        except (OSError, sqlite3.Error) as error:
            raise UsageError(
                f"{folder}: the hand-ins cannot be opened ({error}): name a folder of your own that no other "
                "`autograder serve` uses"
            ) from None

    def _prepare_tables(self) -> None:
        (version,) = self._database.execute("PRAGMA user_version").fetchone()
        if version == 0:
            for statement in _TABLES:
                self._database.execute(statement)
            self._database.execute(f"PRAGMA user_version = {VERSION}")
        elif version != VERSION:
            raise sqlite3.DatabaseError(f"they have version {version}, but this program needs version {VERSION}")
        # Interrupted gradings are repeated.
        self._database.execute("UPDATE hand_in SET turn = NULL WHERE status IS NULL")

    def close(self) -> None:
        """Close the store, so that another process can open it."""
        self._database.close()

    def receive(self, student: str, assignment: str, key: str, answer: bytes, at: datetime) -> HandIn:
        """Store an answer, and return its hand-in. If the student's key is known, return the existing hand-in."""
        with self._transaction():
            row = (student, assignment, key, at.isoformat())
            cursor = self._database.execute(
                "INSERT INTO hand_in (student, assignment, key, at) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING", row
            )
            if cursor.rowcount:
                self._database.execute("INSERT INTO answer VALUES (?, ?)", (cursor.lastrowid, answer))
        hand_in = self.with_key(student, key)
        assert hand_in is not None
        return hand_in

    def begin(self, number: int) -> bytes:
        """Record that the grading of a hand-in begins, and return the answer."""
        with self._transaction():
            self._database.execute(
                "UPDATE hand_in SET turn = 1 + (SELECT COALESCE(MAX(turn), 0) FROM hand_in) WHERE number = ?", (number,)
            )
        (data,) = self._database.execute("SELECT data FROM answer WHERE number = ?", (number,)).fetchone()
        return bytes(data)

    def finish(self, number: int, mark: Mark) -> None:
        """Record the mark of a hand-in whose folder is complete."""
        _flush(self.folder(number))
        with self._transaction():
            self._database.execute(
                "UPDATE hand_in SET status = ?, points = ?, max_points = ? WHERE number = ?",
                (mark.status.value, mark.points, mark.max_points, number),
            )

    def grade_again(self, assignment: str) -> None:
        """Put all graded hand-ins of an assignment back into the queue. They lose their marks."""
        with self._transaction():
            self._database.execute(
                "UPDATE hand_in SET turn = NULL, status = NULL, points = NULL, max_points = NULL WHERE assignment = ? "
                "AND status NOT NULL",
                (assignment,),
            )

    def folder(self, number: int) -> Path:
        """Return the folder of a hand-in's result."""
        return self._gradings / f"{number:06}"

    def waiting(self) -> list[HandIn]:
        """Return the ungraded hand-ins in the order of their arrival."""
        return self._select("status IS NULL")

    def turns(self) -> dict[str, int]:
        """Return the number of each student's last turn, for `queue`."""
        return dict(
            self._database.execute("SELECT student, MAX(turn) FROM hand_in WHERE turn NOT NULL GROUP BY student")
        )

    def with_number(self, number: int) -> HandIn | None:
        """Return the hand-in with this number, or None."""
        return next(iter(self._select("number = ?", number)), None)

    def with_key(self, student: str, key: str) -> HandIn | None:
        """Return a student's hand-in with this key, or None."""
        return next(iter(self._select("student = ? AND key = ?", student, key)), None)

    def of_student(self, student: str) -> list[HandIn]:
        """Return a student's hand-ins in the order of their arrival."""
        return self._select("student = ?", student)

    def of_assignment(self, assignment: str) -> list[HandIn]:
        """Return all hand-ins of an assignment in the order of their arrival."""
        return self._select("assignment = ?", assignment)

    def _select(self, condition: str, *values: str | int) -> list[HandIn]:
        rows = self._database.execute(f"SELECT {_COLUMNS} FROM hand_in WHERE {condition} ORDER BY number", values)
        return [_hand_in(row) for row in rows]

    @contextmanager
    def _transaction(self) -> Iterator[None]:
        self._database.execute("BEGIN IMMEDIATE")
        try:
            yield
        except BaseException:
            self._database.execute("ROLLBACK")
            raise
        self._database.execute("COMMIT")


def _hand_in(row: Sequence[object]) -> HandIn:
    number, student, assignment, at, status, points, max_points = row
    mark = None if status is None else Mark(Status(status), float(str(points)), float(str(max_points)))
    return HandIn(int(str(number)), str(student), str(assignment), datetime.fromisoformat(str(at)), mark)


def _flush(folder: Path) -> None:
    """Flush the files of a folder, and their names, to the disk."""
    for path in (*folder.iterdir(), folder, folder.parent):
        descriptor = os.open(path, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
