"""A program that publishes without end fails with a reason, before its messages fill the grader's memory."""

from __future__ import annotations

import time
from collections.abc import Iterator

import pytest
import rclpy
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import String

from autograder.diagnosis import Kind
from autograder.exceptions import StudentError
from autograder.harness import grader_node
from autograder.harness.grader_node import GraderNode, requested_qos
from autograder.harness.inflow import Inflow
from autograder.run.sandbox.limits import RECEIVED_MESSAGES, MessageLimits

DOMAIN = 87
SECONDS = 30.0  # of real time, as a deadline for events that must happen


def exceed_limit(inflow: Inflow, topic: str, size: int) -> str:
    """Count one message more than allowed; return the sentence of the error."""
    with pytest.raises(StudentError) as excinfo:
        inflow.add(topic, size)
    assert excinfo.value.diagnosis.kind is Kind.FLOODED_OUTPUT
    return excinfo.value.diagnosis.sentence


def test_one_message_too_many_names_the_topic_with_the_most_messages() -> None:
    inflow = Inflow(MessageLimits(messages=10))
    for topic in ("/loud", "/loud", "/quiet") * 3:
        inflow.add(topic, 8)
    inflow.add("/loud", 8)
    assert "sent 7 messages (0.0 MiB in all) on /loud" in exceed_limit(inflow, "/quiet", 8)


def test_the_total_size_of_messages_is_bounded() -> None:
    inflow = Inflow()
    for _ in range(4):
        inflow.add("/map", RECEIVED_MESSAGES.size // 4)
    sentence = exceed_limit(inflow, "/map", RECEIVED_MESSAGES.size // 4)
    assert "5 messages (80.0 MiB in all) on /map" in sentence
    assert "100,000 messages and 64 MiB" in sentence


@pytest.fixture
def programs_node() -> Iterator[Node]:
    """A node like a student's, in the domain of the grader's node."""
    context = Context()
    rclpy.init(args=[], context=context, domain_id=DOMAIN)
    node = Node("flood", context=context)
    yield node
    node.destroy_node()
    context.try_shutdown()


@pytest.fixture
def grader() -> Iterator[GraderNode]:
    """The grader's node."""
    node = GraderNode(DOMAIN)
    yield node
    node.close()


def test_the_grader_stops_receiving_from_a_program_that_publishes_without_end(
    programs_node: Node, grader: GraderNode, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(grader, "_inflow", Inflow(MessageLimits(messages=50)))
    monkeypatch.setattr(grader_node, "DEPTH", 20)
    received: list[String] = []
    grader.subscribe("/flood", String, lambda message, _: received.append(message), requested_qos([]))
    publisher = programs_node.create_publisher(String, "/flood", 100)

    def flood() -> None:
        deadline = time.monotonic() + SECONDS
        while time.monotonic() < deadline:
            publisher.publish(String(data="again"))
            grader.spin(0.01)

    with pytest.raises(StudentError, match=r"sent 51 messages .* on /flood"):
        flood()
    assert len(received) == 50


def test_bytes_that_are_not_a_message_of_the_type_are_ignored(programs_node: Node, grader: GraderNode) -> None:
    received: list[str] = []
    grader.subscribe("/said", String, lambda message, _: received.append(message.data), requested_qos([]))
    publisher = programs_node.create_publisher(String, "/said", 100)
    deadline = time.monotonic() + SECONDS
    while not received and time.monotonic() < deadline:
        publisher.publish(b"\0\1\0\0")
        publisher.publish(String(data="good"))
        grader.spin(0.05)
    assert set(received) == {"good"}
