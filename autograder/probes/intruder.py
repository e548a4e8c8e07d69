"""Another robot on the same network: publishes empty messages on the topics that it is given, until it is killed.

    python intruder.py TOPIC=PACKAGE/msg/TYPE...

Runs in a sandbox of its own. It says `ready` once it publishes.
"""

from __future__ import annotations

import importlib
import sys

import rclpy

PERIOD = 0.01  # s


def main() -> None:
    """Publish, a hundred times a second."""
    rclpy.init()
    node = rclpy.create_node("another_robot")
    pairs = []
    for argument in sys.argv[1:]:
        topic, _, name = argument.partition("=")
        package, _, kind = name.partition("/msg/")
        message = getattr(importlib.import_module(f"{package}.msg"), kind)()
        pairs.append((node.create_publisher(type(message), topic, 10), message))

    def disturb() -> None:
        for publisher, message in pairs:
            publisher.publish(message)

    node.create_timer(PERIOD, disturb)
    print("ready", flush=True)
    rclpy.spin(node)


if __name__ == "__main__":
    main()
