"""Tells whether every endpoint in a harness has discovered all its peers. No message is lost from then on."""

from __future__ import annotations

from collections.abc import Sequence

from autograder.harness.grader_node import GraderNode
from autograder.run.lockstep.protocol import Description


def connected(programs: Sequence[Description], grader_node: GraderNode) -> bool:
    """Return whether the known endpoints of the programs and of the grader's node have discovered their peers."""
    readers = [reader.channels for reader in grader_node.readers if reader.kind == "subscription"]
    readers = [*(names for program in programs for names, _ in program.readers), *readers]
    writers = [*(name for program in programs for name, _ in program.writers), *grader_node.publisher_channels.values()]
    served_channels = {name for program in programs for name in program.servers}

    def subscriptions(channel: str) -> int:
        return sum(channel in names for names in readers)

    def publishers(names: tuple[str, ...]) -> int:
        return sum(channel in names for channel in writers)

    return (
        all(count >= subscriptions(name) for program in programs for name, count in program.writers)
        and all(count is None or count >= publishers(names) for program in programs for names, count in program.readers)
        and all(ready or name not in served_channels for program in programs for name, ready in program.clients)
        and all(
            publisher.get_subscription_count() >= subscriptions(grader_node.publisher_channels[topic])
            for topic, publisher in grader_node.publishers.items()
        )
        and all(
            reader.entity.handle.get_publisher_count() >= publishers(reader.channels)
            for reader in grader_node.readers
            if reader.kind == "subscription"
        )
        and all(
            client.service_is_ready() or channel not in served_channels for channel, client in grader_node.clients()
        )
    )
