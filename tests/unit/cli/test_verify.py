"""The command line: the options of `autograder verify`."""

from __future__ import annotations

import pytest
from click.testing import CliRunner

from autograder.cli.verify import verify


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--record", "--quick"), "--record needs complete gradings: remove --quick"),
        (("--mutants", "--named"), "--mutants grades only generated mutants, and the other option grades none"),
        (("--mutants", "--quick"), "--mutants grades only generated mutants, and the other option grades none"),
        (
            ("--named", "--only", "no_such"),
            "no submission is called no_such: --only takes reference, release, the names of variants and attacks, and "
            "the ids of mutants",
        ),
    ],
)
def test_options_that_select_nothing_are_refused(arguments: tuple[str, ...], message: str) -> None:
    result = CliRunner().invoke(verify, ["--assignment", "02_nodes", *arguments])
    assert result.exit_code == 2
    assert message in " ".join(result.output.split())
