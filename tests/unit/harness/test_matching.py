"""Programs and grader are connected when each has discovered all endpoints that it is joined to."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.harness.grader_node import GraderNode
from autograder.harness.matching import connected
from autograder.run.lockstep.protocol import Description

SCAN, ASK = "/scan T reliable volatile", "/ask T request"


@pytest.fixture
def grader_node(ros_domain: int) -> Iterator[GraderNode]:
    made = GraderNode(ros_domain)
    yield made
    made.close()


def _program(writers: int | None = None, readers: int | None = None, ready: bool | None = None, serves: bool = False):  # type: ignore[no-untyped-def]
    return Description(
        writers=() if writers is None else ((SCAN, writers),),
        readers=() if readers is None else (((SCAN,), readers),),
        clients=() if ready is None else ((ASK, ready),),
        servers=(ASK,) if serves else (),
    )


@pytest.mark.parametrize(
    ("programs", "matched"),
    [
        ([], True),
        ([_program(writers=0)], True),
        ([_program(writers=0), _program(readers=1)], False),
        ([_program(writers=1), _program(readers=0)], False),
        ([_program(writers=1), _program(readers=1)], True),
        ([_program(writers=1), _program(readers=1), _program(readers=1)], False),
        ([_program(writers=1), _program(writers=1), _program(readers=2)], True),
        ([_program(ready=False)], True),
        ([_program(ready=False), _program(serves=True)], False),
        ([_program(ready=True), _program(serves=True)], True),
    ],
)
def test_programs_are_connected_when_each_has_discovered_all_its_endpoints(
    programs: list[Description], matched: bool, grader_node: GraderNode
) -> None:
    assert connected(programs, grader_node) is matched
