"""What a worker hears of interface packages that do not build."""

from __future__ import annotations

from multiprocessing import Pipe
from pathlib import Path

import pytest

from autograder.building import keeper
from autograder.building.colcon import StoppedBuildError
from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError


@pytest.mark.parametrize("error", [StudentError, StoppedBuildError])
def test_a_build_that_a_limit_ended_is_not_tried_again_by_who_asked_for_it(
    error: type[StudentError], tmp_path: Path
) -> None:
    ours, theirs = Pipe()
    with ours, theirs:
        keeper.send_message(theirs, keeper.refused(error(Diagnosis(Kind.BUILD_FAILED, "It was stopped."))))
        with pytest.raises(StudentError, match="It was stopped") as raised:
            keeper.ask(ours, {}, tmp_path / "made")
    assert type(raised.value) is error
