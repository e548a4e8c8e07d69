"""Code that a student adds to the library of a message package runs only in sandboxes."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from tests.e2e.sandbox_support import in_worker_sandbox
from tests.e2e.trigraph import trigraph_text

PACKAGES = ("my_robot_interfaces", "my_robot_package")
# Each process that loads the library prints which of the grader's files it can read and write.
PAYLOAD = """
#include <stdio.h>
__attribute__((constructor)) static void run(void) {
    FILE * file = fopen("%s", "r");
    printf("PAYLOAD ran%%s", file ? ", and can read a hidden CHECK" : "");
    file = fopen("%s", "r+");  // an existing file: a new one would be in the sandbox's own /tmp
    printf("%%s\\n", file ? ", and can write a RESULT" : "");
    fflush(stdout);
}
"""
LINK = "target_sources(${PROJECT_NAME}__rosidl_generator_c PRIVATE payload.c)\n"


def exchange_messages(scratch: Path) -> dict[str, Any]:
    """Build messages with a payload in their library, exchange some with a node, and return what the payload did."""
    from autograder import course_paths
    from autograder.author.verification.mutants import write_reference
    from autograder.building.build import build
    from autograder.checks.ch03_interfaces.support.reporter import Reporter
    from autograder.checks.ch03_interfaces.support.types import load_types
    from autograder.harness import Workspace
    from autograder.ros import activate

    (scratch / "home").mkdir()
    (scratch / "result.json").touch()
    workspace = Workspace(scratch / "ws", activate(), scratch / "home")
    write_reference(PACKAGES, workspace.root)
    folder = workspace.root / "src" / PACKAGES[0]
    hidden = course_paths.CHECKS / "ch03_interfaces" / "hidden" / "status.py"
    (folder / "payload.c").write_text(PAYLOAD % (hidden, scratch / "result.json"))
    cmake, message = folder / "CMakeLists.txt", folder / "msg" / "RobotStatus.msg"
    cmake.write_text(cmake.read_text().replace("ament_export", f"{LINK}ament_export", 1))
    message.write_text(f"string EVIL='{trigraph_text(scratch / 'outside')}'\n{message.read_text()}")
    build(workspace, PACKAGES)
    with Reporter(workspace, load_types(workspace)) as reporter:
        reporter.publish_battery(0.5)
        level = reporter.status().battery_level
        trip = reporter.ask([1.0])
        output = reporter.output
    maps = Path("/proc/self/maps").read_text()
    return {
        "level": level,
        "trip": trip.possible,
        "printed": sorted({line for line in output.splitlines() if "PAYLOAD" in line}),
        "outside": (scratch / "outside").exists(),
        "loaded": [line for line in maps.splitlines() if PACKAGES[0] in line or "payload" in line],
    }


def test_code_in_a_message_library_runs_only_in_the_sandbox() -> None:
    answer = in_worker_sandbox(exchange_messages)
    assert answer == {"level": 50, "trip": True, "printed": ["PAYLOAD ran"], "outside": False, "loaded": []}
