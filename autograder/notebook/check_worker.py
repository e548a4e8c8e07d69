"""The trusted process behind a notebook: it builds the workspace and drives or checks, as grading does.

python -m autograder.notebook.check_worker REQUEST
"""

from __future__ import annotations

import dataclasses
import json
import shutil
import sys
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

from autograder import layout
from autograder.diagnosis import OK, Diagnosis
from autograder.exceptions import GraderError, StudentError
from autograder.notebook.worker_client import ANSWER, RECORDING
from autograder.result import write_json
from autograder.ros import activate
from autograder.ros.domains import Domain
from autograder.sandbox.launcher import current_tier, heed_interrupts
from autograder.sandbox.tiers import Tier

if TYPE_CHECKING:
    from autograder.building.observed import Observed
    from autograder.checks.suites import Suite
    from autograder.workspace import Workspace

    Run = Callable[[Workspace, Observed, Path], dict[str, Any]]
    Plan = tuple[tuple[str, ...], bool, Run]  # the packages, whether their build may fail, what to do then

SEED = 1  # of the visible checks' inputs


def main() -> None:
    """Run the request that the command line holds."""
    request = json.loads(sys.argv[1])
    heed_interrupts()
    ros = activate()
    # Imported once ROS is switched on: these reach rclpy.
    from autograder.building.observed import build_workspace
    from autograder.workspace import Workspace

    scratch, out = Path(request["scratch"]), Path(request["out"])
    home = scratch / "home"
    home.mkdir(parents=True)
    domain = 0 if current_tier() is Tier.BUBBLEWRAP else Domain().number
    workspace = Workspace(scratch / "ws", ros, home, domain=domain)
    shutil.copytree(request["source"], workspace.root / "src", ignore=layout.NOT_COPIED)
    packages, may_fail, run = {"drive": _for_drive, "check": _for_check}[request["verb"]](request["arguments"])
    answer: dict[str, Any] = {"diagnosis": _plain(OK)}
    try:
        answer |= run(workspace, build_workspace(workspace, packages, may_fail=may_fail), out)
    except StudentError as error:
        answer["diagnosis"] = _plain(error.diagnosis)
    if request["verb"] == "check":
        answer["declared"] = [dataclasses.asdict(check) for check in _visible(request["arguments"]).checks]
    write_json(out / ANSWER, answer)


def _for_drive(arguments: dict[str, Any]) -> Plan:
    def run(workspace: Workspace, _: Observed, out: Path) -> dict[str, Any]:
        from autograder.harness import SteppedHarness, drive
        from autograder.harness.drive import LISTENS, OFFERS
        from sim.codec import from_json

        program = arguments["package"], arguments["executable"]
        options = _options(workspace.scratch, arguments["name"], arguments["parameters"])
        with SteppedHarness(workspace, *program, offers=OFFERS, listens=LISTENS, arguments=options) as harness:
            done = drive(harness, from_json(arguments["simulation"]), arguments["seconds"])
        done.recording.save(out / RECORDING)
        commands = [[c.seconds, c.message.linear.x, c.message.angular.z] for c in done.commands]
        return {"output": done.output, "commands": commands}

    return (arguments["package"],), False, run


def _options(scratch: Path, name: str | None, parameters: list[str]) -> tuple[str, ...]:
    """Return ROS arguments for a name and the texts of parameter files, written where the sandbox sees them."""
    options = ["--ros-args"] if name or parameters else []
    options += ["-r", f"__node:={name}"] if name else []
    for number, text in enumerate(parameters):
        path = scratch / f"parameters_{number}.yaml"
        path.write_text(text)
        options += ["--params-file", str(path)]
    return tuple(options)


def _for_check(arguments: dict[str, Any]) -> Plan:
    suite = _visible(arguments)

    def run(workspace: Workspace, observed: Observed, out: Path) -> dict[str, Any]:
        from autograder.gallery import Gallery
        from autograder.grading.plugin import GradingPlugin
        from autograder.grading.plugin import run as run_suite

        plugin = GradingPlugin(workspace, SEED, Gallery(out), observed.diagnoses)
        run_suite(suite.files, plugin)
        if plugin.failures:
            raise GraderError("\n".join(plugin.failures))
        checks = [dataclasses.asdict(result) for result in plugin.results.values()]
        diagnosis = plugin.diagnosis if observed.diagnosis is OK else observed.diagnosis
        return {"diagnosis": _plain(diagnosis), "checks": checks}

    return suite.packages, suite.build_may_fail, run


def _visible(arguments: dict[str, Any]) -> Suite:
    from autograder.checks import suites

    return suites.visible(arguments["assignment"])


def _plain(diagnosis: Diagnosis) -> dict[str, str]:
    return {"kind": diagnosis.kind.value, "sentence": diagnosis.sentence, "detail": diagnosis.detail}


if __name__ == "__main__":
    main()
