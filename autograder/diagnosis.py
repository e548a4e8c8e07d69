"""Names and sentences for the problems of a submission that are found before its behaviour is checked."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

from autograder.plain_text import shorten

MAX_SENTENCE = 4_000  # characters; a sentence may quote what a program printed
MAX_DETAIL = 16_000  # characters; longer output is shortened


class Kind(str, Enum):
    """The outcomes of reading, building and starting a submission."""

    OK = "ok"
    UNSAFE_ARCHIVE = "unsafe_archive"
    UNREADABLE = "unreadable"
    UNCLEAR = "unclear"
    NOTHING_SUBMITTED = "nothing_submitted"
    NOTEBOOK_FAILED = "notebook_failed"
    MISSING_PACKAGE = "missing_package"
    HALF_WRITTEN_PACKAGE = "half_written_package"
    UNFINISHED = "unfinished"
    SYNTAX_ERROR = "syntax_error"
    BUILD_FAILED = "build_failed"
    MISSING_EXECUTABLE = "missing_executable"
    CRASHED_AT_IMPORT = "crashed_at_import"
    CRASHED_AT_START = "crashed_at_start"
    CRASHED_LATER = "crashed_later"
    ENDED_EARLY = "ended_early"
    NEVER_STARTED = "never_started"
    STUCK = "stuck"
    RESERVED_NAME = "reserved_name"
    UNUSABLE_COMMAND = "unusable_command"
    FLOODED_OUTPUT = "flooded_output"
    OUT_OF_MEMORY = "out_of_memory"
    TIMED_OUT = "timed_out"
    NOT_GRADED = "not_graded"


# Hints for a program that crashed. They do not depend on the check that ran at that time.
HINTS = {
    kind: ("Read the traceback from its last line upwards. The first line that names a file of yours says where.",)
    for kind in (Kind.SYNTAX_ERROR, Kind.CRASHED_AT_IMPORT, Kind.CRASHED_AT_START, Kind.CRASHED_LATER)
}


@dataclass(frozen=True)
class Diagnosis:
    """The outcome of reading, building and starting one submission, and advice for the student.

    `detail` contains the relevant lines of output or of a traceback. It may be empty. Texts that are too long are
    shortened.
    """

    kind: Kind
    sentence: str
    detail: str = ""

    def __post_init__(self) -> None:
        object.__setattr__(self, "sentence", shorten(self.sentence, MAX_SENTENCE))
        object.__setattr__(self, "detail", shorten(self.detail, MAX_DETAIL))

    @property
    def hints(self) -> tuple[str, ...]:
        """Hints for the student, in order. Most diagnoses have none, because their sentence already says what to do."""
        return HINTS.get(self.kind, ())


OK = Diagnosis(Kind.OK, "The package was built and its node runs.")
