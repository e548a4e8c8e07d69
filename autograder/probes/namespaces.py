"""Starts a program in a namespace, and finds the names that it does not take with it: those that begin with a slash."""

from __future__ import annotations

from collections.abc import Iterable

from autograder.harness import AutoHarness, Workspace
from autograder.probes.qos import non_default_qos

SPACE = "/robot7"
SEEN_SECONDS = 5.0  # of real time until a name is seen in the graph; only a wrong program takes so long


def missing_in_namespace(
    workspace: Workspace, package: str, executable: str, names: Iterable[str], *, plain: bool = False
) -> str:
    """Return which relative names a program does not have in the namespace in which it is started, in a sentence.

    The names are its topics and services. The sentence is empty if it has all of them there, and where `plain` asks for
    it, if the queues of its topics are plain, as `non_default_qos` says.
    """
    full_names = [f"{SPACE}/{name}" for name in names]
    with AutoHarness(workspace, package, executable, arguments=("--ros-args", "-r", f"__ns:={SPACE}")) as harness:

        def missing() -> list[str]:
            graph = harness.node
            there = {name for name, _ in graph.get_topic_names_and_types() + graph.get_service_names_and_types()}
            return [name for name in full_names if name not in there]

        harness.wait_for(lambda: not missing(), SEEN_SECONDS)
        left = missing()
        differs = non_default_qos(harness.node, *full_names) if plain else ""
    if not left:
        return differs
    return (
        f"Started in the namespace {SPACE}, {executable} has no {' and no '.join(left)}: a relative name has no slash."
    )
