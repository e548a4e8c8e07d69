"""Programs and grader are connected when each has discovered all endpoints that it is joined to."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
import rclpy
from std_msgs.msg import String

from autograder.harness.grader_node import GraderNode
from autograder.harness.matching import connected
from autograder.run.lockstep.protocol import Description

SCAN, ASK = "/scan T reliable volatile", "/ask T request"


@pytest.fixture
def grader_node(ros_domain: int) -> Iterator[GraderNode]:
    node = GraderNode(ros_domain)
    yield node
    node.close()


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


def test_the_topics_of_a_node_are_listed_once_the_nodes_of_all_endpoints_are_known(
    grader_node: GraderNode, ros_domain: int
) -> None:
    context, nodes = rclpy.Context(), []
    rclpy.init(context=context, domain_id=ros_domain)
    try:
        for number in range(20):
            topic, name = f"/topic_{number}", f"node_{number}"
            nodes.append(rclpy.create_node(name, context=context))
            nodes[-1].create_publisher(String, topic, 1)
            deadline = time.monotonic() + 30
            while not (grader_node.publishers_of(topic) and grader_node.knows_nodes_of([topic])):
                assert time.monotonic() < deadline
                grader_node.spin(0.001)
            assert topic in dict(grader_node.node.get_publisher_names_and_types_by_node(name, "/"))
    finally:
        context.shutdown()
