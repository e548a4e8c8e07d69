"""A change of a file that all gradings share needs a decision about GRADER_VERSION."""

from __future__ import annotations

import pytest

from tests.unit.fingerprint.record import RECORD, _effective_lines, current

HELP = """
These files, which all gradings share, differ from their record for {version}. If a submission can get another
mark, or another reason for it, with the same seed, raise GRADER_VERSION in autograder/suite/fingerprint.py. Then, or
if no mark can change, record them again: python -m tests.unit.fingerprint.record
"""


def test_the_shared_files_are_unchanged_since_this_version_was_recorded() -> None:
    recorded, now = RECORD.read_text(encoding="utf-8").splitlines(), current().splitlines()
    changed = sorted({line.split()[-1] for line in {*recorded} ^ {*now}})
    if changed:
        pytest.fail(HELP.format(version=recorded[0]) + "\n".join(changed), pytrace=False)


def test_comments_and_docstrings_do_not_count_as_a_change() -> None:
    source = (
        '"""What it is."""\n\n# Why.\ndef f():\n    """Return.\n\n    Two.\n    """\n    return """\n# text"""  # 2\n'
    )
    assert list(_effective_lines(source)) == ["def f():", '    return """', '# text"""  # 2']
