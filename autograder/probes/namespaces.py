"""Starts a program in a namespace, and finds the names that stay outside it because they begin with a slash."""

from __future__ import annotations

from collections.abc import Iterable

from autograder.harness import AutoHarness, Workspace
from autograder.probes.qos import non_default_qos

NAMESPACE = "/robot7"
DISCOVERY_SECONDS = 5.0  # real time to wait for a name in the graph; only a wrong program takes so long


def missing_in_namespace(
    workspace: Workspace, package: str, executable: str, names: Iterable[str], *, plain: bool = False
) -> str:
    """Return a sentence that names the topics and services that a program does not have in its namespace.

    The sentence is empty if it has all of them there. If `plain` is set, `non_default_qos` also tests the topics, and
    the sentence describes a profile that differs.
    """
    full_names = [f"{NAMESPACE}/{name}" for name in names]
    with AutoHarness(workspace, package, executable, arguments=("--ros-args", "-r", f"__ns:={NAMESPACE}")) as harness:

        def missing_names() -> list[str]:
            graph = harness.node
            present = {name for name, _ in graph.get_topic_names_and_types() + graph.get_service_names_and_types()}
            return [name for name in full_names if name not in present]

        harness.wait_for(lambda: not missing_names(), DISCOVERY_SECONDS)
        absent = missing_names()
        difference = non_default_qos(harness.node, *full_names) if plain else ""
    if not absent:
        return difference
    return (
        f"Started in the namespace {NAMESPACE}, {executable} has no {' and no '.join(absent)}: "
        "a relative name does not begin with a slash."
    )
