"""The grader node chooses the quality of service that fits all programs of a student."""

from __future__ import annotations

from types import SimpleNamespace

from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy

from autograder.harness import grader_node


def _peer(reliability: ReliabilityPolicy, durability: DurabilityPolicy) -> SimpleNamespace:
    return SimpleNamespace(qos_profile=QoSProfile(depth=1, reliability=reliability, durability=durability))


def test_the_grader_offers_a_quality_of_service_that_fits_every_subscription() -> None:
    weak = _peer(ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)
    strong = _peer(ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)
    assert grader_node.offered_qos([weak]).durability == DurabilityPolicy.VOLATILE
    offered_profile = grader_node.offered_qos([weak, strong])
    assert (offered_profile.reliability, offered_profile.durability) == (
        strong.qos_profile.reliability,
        strong.qos_profile.durability,
    )


def test_the_grader_requests_a_quality_of_service_that_every_publisher_offers() -> None:
    weak = _peer(ReliabilityPolicy.BEST_EFFORT, DurabilityPolicy.VOLATILE)
    strong = _peer(ReliabilityPolicy.RELIABLE, DurabilityPolicy.TRANSIENT_LOCAL)
    assert grader_node.requested_qos([strong]).reliability == ReliabilityPolicy.RELIABLE
    assert grader_node.requested_qos([strong, weak]).reliability == ReliabilityPolicy.BEST_EFFORT
