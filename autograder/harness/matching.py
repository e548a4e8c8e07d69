"""Matching: whether every endpoint in a harness sees all that it is joined to. Nothing is lost from then on."""

from __future__ import annotations

from collections.abc import Sequence

from autograder.harness.grader_node import GraderNode
from autograder.lockstep.protocol import Description


def connected(programs: Sequence[Description], grader_node: GraderNode) -> bool:
    """Return whether the programs and the grader's grader_node see each other, as far as each of them can tell."""
    ears = [ear.channels for ear in grader_node.ears if ear.kind == "subscription"]
    readers = [*(names for program in programs for names, _ in program.readers), *ears]
    writers = [*(name for program in programs for name, _ in program.writers), *grader_node.written.values()]
    answered = [ear.channels[0] for ear in grader_node.ears if ear.kind == "service"]
    served = {*answered, *(name for program in programs for name in program.servers)}

    def heard(channel: str) -> int:
        return sum(channel in names for names in readers)

    def said(names: tuple[str, ...]) -> int:
        return sum(channel in names for channel in writers)

    return (
        all(seen >= heard(name) for program in programs for name, seen in program.writers)
        and all(seen is None or seen >= said(names) for program in programs for names, seen in program.readers)
        and all(ready or name not in served for program in programs for name, ready in program.clients)
        and all(
            publisher.get_subscription_count() >= heard(grader_node.written[topic])
            for topic, publisher in grader_node.publishers.items()
        )
        and all(
            ear.entity.handle.get_publisher_count() >= said(ear.channels)
            for ear in grader_node.ears
            if ear.kind == "subscription"
        )
        and all(client.service_is_ready() or channel not in served for channel, client in grader_node.clients())
    )
