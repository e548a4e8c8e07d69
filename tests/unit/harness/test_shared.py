"""Several checks share one harness."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest

from autograder.diagnosis import Diagnosis, Kind
from autograder.exceptions import StudentError
from autograder.harness import Shared
from autograder.run.sandbox import ExitReason


class Fake:
    """A harness whose programs end when the test says so."""

    def __init__(self) -> None:
        self.processes: Any = (SimpleNamespace(exit_reason=None), SimpleNamespace(exit_reason=None))
        self.inside = False

    def __enter__(self) -> Fake:
        self.inside = True
        return self

    def __exit__(self, *ending: object) -> None:
        self.inside = False


def test_checks_get_the_same_harness_until_the_block_ends() -> None:
    with Shared(Fake) as shared:
        first = shared.get()
        assert first.inside
        assert shared.get() is first
    assert not first.inside


def test_a_harness_is_replaced_once_one_of_its_programs_has_ended() -> None:
    with Shared(Fake) as shared:
        first = shared.get()
        first.processes[1].exit_reason = ExitReason.EXITED
        second = shared.get()
    assert second is not first
    assert not first.inside


def test_a_harness_is_replaced_once_it_is_no_longer_usable() -> None:
    unusable: list[Fake] = []
    with Shared(Fake, lambda fake: fake not in unusable) as shared:
        first = shared.get()
        unusable.append(first)
        assert shared.get() is not first


def test_a_closed_harness_ends_and_the_next_check_gets_a_new_one() -> None:
    with Shared(Fake) as shared:
        first = shared.get()
        shared.close()
        assert not first.inside
        assert shared.get() is not first


def test_after_a_harness_that_does_not_start_the_next_check_tries_again() -> None:
    broken = [True]

    def make() -> Fake:
        if broken:
            broken.pop()
            raise ValueError("it does not start")
        return Fake()

    with Shared(make) as shared:
        with pytest.raises(ValueError, match="does not start"):
            shared.get()
        assert shared.get().inside


def test_programs_that_do_not_start_are_started_once_and_each_check_gets_the_error() -> None:
    starts: list[None] = []

    def make() -> Fake:
        starts.append(None)
        raise StudentError(Diagnosis(Kind.NEVER_STARTED, "It does not start."))

    with Shared(make) as shared:
        for _ in range(3):
            with pytest.raises(StudentError, match="does not start"):
                shared.get()
    assert len(starts) == 1
