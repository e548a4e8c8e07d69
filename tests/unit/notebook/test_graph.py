"""The graph of the running system shows publishers and subscriptions, without the topics that every node has."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import String

from autograder.notebook import graph
from autograder.notebook.node_graph import Graph
from autograder.notebook.notices import Notice


@pytest.mark.slow
def test_the_graph_shows_the_running_nodes_and_topics() -> None:
    context = Context()
    rclpy.init(context=context)
    driver = Node("driver", namespace="robot1", context=context)
    driver.create_publisher(Twist, "cmd_vel", 10)
    reporter = Node("reporter", context=context)
    reporter.create_subscription(Twist, "/robot1/cmd_vel", print, 10)
    reporter.create_publisher(String, "status", 10)
    try:
        live_graph = graph(30.0)
    finally:
        rclpy.try_shutdown(context=context)
    assert isinstance(live_graph, Graph)
    assert live_graph.nodes == ("/reporter", "/robot1/driver")
    assert live_graph.topics == {"/robot1/cmd_vel": "geometry_msgs/msg/Twist", "/status": "std_msgs/msg/String"}
    assert live_graph.published == {("/robot1/driver", "/robot1/cmd_vel"), ("/reporter", "/status")}
    assert live_graph.subscribed == {("/robot1/cmd_vel", "/reporter")}
    assert repr(live_graph).splitlines()[0] == "2 nodes: /reporter, /robot1/driver"


def test_the_drawing_has_a_box_for_each_node_and_topic_and_an_arrow_for_each_pair() -> None:
    html = Graph(
        ("/a", "/alone", "/b"),
        {"/t": "std_msgs/msg/String"},
        frozenset({("/a", "/t")}),
        frozenset({("/t", "/a"), ("/t", "/b")}),
    )._repr_html_()
    root = ElementTree.fromstring(html)
    svg = "{http://www.w3.org/2000/svg}"
    assert sorted(text.text or "" for text in root.iter(f"{svg}text")) == [
        "/a", "/a", "/alone", "/b", "/t", "std_msgs/msg/String",
    ]  # fmt: skip
    assert len([path for path in root.iter(f"{svg}path") if path.get("class") == "head"]) == 3


def test_the_graph_is_not_read_while_the_notebook_is_graded(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("AUTOGRADER_GRADING", "1")
    assert isinstance(graph(), Notice)
