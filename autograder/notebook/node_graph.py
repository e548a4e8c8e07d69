"""`graph` draws the ROS graph of the running system: its nodes and the topics between them."""

from __future__ import annotations

import html
import time
from dataclasses import dataclass
from typing import Any

from autograder.notebook.notices import Notice
from autograder.ros.discovery import fast_discovery
from sim.grading import grading

HIDDEN_TOPICS = ("/rosout", "/parameter_events", "/clock")  # topics of nearly every node, which clutter the drawing
STABLE_SECONDS = 1.0  # real time; if the graph has not changed for this long, discovery counts as finished
# In pixels: the height of a row, the widths of a node's and a topic's box, and the space between columns.
ROW, NODE, TOPIC, GAP = 46, 190, 210, 110

STYLE = """
.ros-graph { font: 13px system-ui, sans-serif; max-width: 100%; }
.ros-graph rect { fill: #0072b222; stroke: #0072b2; } .ros-graph rect.topic { fill: #8886; stroke: none; }
.ros-graph text { fill: currentColor; text-anchor: middle; } .ros-graph text.kind { font-size: 10px; opacity: .75; }
.ros-graph path { fill: none; stroke: currentColor; stroke-opacity: .7; }
.ros-graph .head { fill: currentColor; stroke: none; }
"""


@dataclass(frozen=True)
class Graph:
    """A ROS graph: its publishers as pairs (node, topic), and its subscriptions as pairs (topic, node)."""

    nodes: tuple[str, ...]
    topics: dict[str, str]
    published: frozenset[tuple[str, str]]
    subscribed: frozenset[tuple[str, str]]

    def __repr__(self) -> str:
        arrows = [f"{node} -> {topic}" for node, topic in sorted(self.published)]
        arrows += [f"{topic} -> {node}" for topic, node in sorted(self.subscribed)]
        return "\n".join([f"{len(self.nodes)} nodes: {', '.join(self.nodes)}", *arrows])

    def _repr_html_(self) -> str:
        """Return a drawing with publishers, topics and subscribers from left to right. A node may be on both sides."""
        left_nodes = sorted(
            {node for node, _ in self.published} | (set(self.nodes) - {node for _, node in self.subscribed})
        )
        right_nodes = sorted({node for _, node in self.subscribed})
        topics = sorted(self.topics)
        height = ROW * max(len(left_nodes), len(right_nodes), len(topics), 1)
        positions = {
            (column, name): (x, (number + 0.5) * height / len(names))
            for column, (x, names) in enumerate(
                ((0, left_nodes), (NODE + GAP, topics), (NODE + TOPIC + 2 * GAP, right_nodes))
            )
            for number, name in enumerate(names)
        }
        boxes = "".join(
            _box(x, y, name, self.topics[name] if column == 1 else None) for (column, name), (x, y) in positions.items()
        )
        arrows = "".join(
            _arrow(positions[0, node], NODE, positions[1, topic]) for node, topic in sorted(self.published)
        )
        arrows += "".join(
            _arrow(positions[1, topic], TOPIC, positions[2, node]) for topic, node in sorted(self.subscribed)
        )
        width = 2 * NODE + TOPIC + 2 * GAP
        return (
            f'<svg class="ros-graph" xmlns="http://www.w3.org/2000/svg" width="{width}"'
            f' viewBox="-2 0 {width + 4} {height}" role="img" aria-label="{html.escape(repr(self), quote=True)}">'
            f"<style>{STYLE}</style>{arrows}{boxes}</svg>"
        )


def graph(seconds: float = 10.0) -> Graph | Notice:
    """Draw the running nodes and the topics between them.

    Args:
        seconds: maximum time to wait. The graph is drawn as soon as there is a node and the graph has not changed for a
            second.

    Raises:
        ModuleNotFoundError: ROS is not active. Call `ros()` first.
    """
    if grading():
        return Notice("The graph is not drawn while the notebook is graded.")
    import rclpy
    from rclpy.context import Context
    from rclpy.node import Node

    context = Context()
    with fast_discovery():
        rclpy.init(context=context)
    try:
        observer = Node("_graph", context=context, start_parameter_services=False, enable_rosout=False)
        return _wait_until_stable(observer, seconds)
    finally:
        rclpy.try_shutdown(context=context)


def _wait_until_stable(observer: Any, seconds: float) -> Graph:
    """Read the graph until it has not changed for `STABLE_SECONDS`, or until `seconds` have passed."""
    deadline = time.monotonic() + seconds
    latest_graph, changed_at = _read_graph(observer), time.monotonic()
    while time.monotonic() < min(deadline, changed_at + STABLE_SECONDS):
        time.sleep(0.05)
        current_graph = _read_graph(observer)
        if current_graph != latest_graph or not current_graph.nodes:
            latest_graph, changed_at = current_graph, time.monotonic()
    return latest_graph


def _read_graph(observer: Any) -> Graph:
    """Return the current graph without hidden nodes, whose names start with an underscore."""
    topics = {name: kinds[0] for name, kinds in observer.get_topic_names_and_types() if name not in HIDDEN_TOPICS}
    publications = {
        (_name(endpoint), topic) for topic in topics for endpoint in observer.get_publishers_info_by_topic(topic)
    }
    subscriptions = {
        (topic, _name(endpoint)) for topic in topics for endpoint in observer.get_subscriptions_info_by_topic(topic)
    }
    nodes = {f"{space.rstrip('/')}/{name}" for name, space in observer.get_node_names_and_namespaces()}
    visible_nodes = tuple(sorted(node for node in nodes if not node.rpartition("/")[2].startswith("_")))
    return Graph(
        visible_nodes,
        topics,
        frozenset(pair for pair in publications if pair[0] in visible_nodes),
        frozenset(pair for pair in subscriptions if pair[1] in visible_nodes),
    )


def _name(endpoint: Any) -> str:
    return f"{endpoint.node_namespace.rstrip('/')}/{endpoint.node_name}"


def _box(x: float, y: float, name: str, kind: str | None) -> str:
    name = html.escape(name)
    if kind is None:
        return (
            f'<rect x="{x}" y="{y - 15}" width="{NODE}" height="30" rx="15"/>'
            f'<text x="{x + NODE / 2}" y="{y + 4}">{name}</text>'
        )
    return (
        f'<rect class="topic" x="{x}" y="{y - 18}" width="{TOPIC}" height="36" rx="3"/>'
        f'<text x="{x + TOPIC / 2}" y="{y - 2}">{name}</text>'
        f'<text class="kind" x="{x + TOPIC / 2}" y="{y + 12}">{html.escape(kind)}</text>'
    )


def _arrow(start: tuple[float, float], width: float, end: tuple[float, float]) -> str:
    x1, y1, x2, y2 = start[0] + width, start[1], end[0] - 8, end[1]
    middle = (x1 + x2) / 2
    return (
        f'<path d="M{x1} {y1}C{middle} {y1} {middle} {y2} {x2} {y2}"/><path class="head" d="M{x2 + 7} {y2}l-8 -4v8z"/>'
    )
