"""The trusted worker process of `drive` and `check`: builds the workspace and runs its programs in sandboxes.

It uses the same code as the grader.

python -m autograder.notebook.check_worker REQUEST DESCRIPTOR

DESCRIPTOR is the file descriptor of a socket (`autograder.run.sandbox.line`) from which the worker gets built interface
packages.
"""

from __future__ import annotations

import json
import shutil
import sys
from collections.abc import Callable, Collection
from dataclasses import asdict
from multiprocessing.connection import Connection
from pathlib import Path
from typing import TYPE_CHECKING, Any

from autograder import course_paths
from autograder.diagnosis import OK, Diagnosis, Kind
from autograder.exceptions import GraderError, StudentError
from autograder.notebook.worker_client import EARLY_FILE, RECORDING, REPLY_FILE
from autograder.result.model import structure, write_json
from autograder.ros import activate
from autograder.ros.domains import Domain
from autograder.run.sandbox import line
from autograder.run.sandbox.isolation import Isolation
from autograder.run.sandbox.launcher import current_isolation, restore_sigint
from autograder.submission import intake
from autograder.submission.reading import reading

if TYPE_CHECKING:
    from autograder.run.workspace import Workspace

SEED = 1  # the seed of the inputs of visible checks, the same for all students
NEEDS_NOTEBOOK = "The visible checks need the executed notebook: run check(...) in it."


def main() -> None:
    """Run the request in the file that the command line names, and write the reply."""
    request = json.loads(Path(sys.argv[1]).read_text())
    line.set_line(Connection(int(sys.argv[2])))
    restore_sigint()
    ros = activate()
    from autograder.run.workspace import Workspace  # imports rclpy, so ROS must be active

    scratch, out = Path(request["scratch"]), Path(request["out"])
    home = scratch / "home"
    home.mkdir(parents=True)
    domain = 0 if current_isolation() is Isolation.BUBBLEWRAP else Domain().number
    workspace = Workspace(scratch / "ws", ros, home, domain=domain)
    try:
        _copy_packages(workspace, Path(request["source"]), request["arguments"])
    except StudentError as error:
        reply: dict[str, Any] = {"diagnosis": asdict(error.diagnosis), "checks": ()}
    else:
        reply = VERBS[request["verb"]](workspace, out, **request["arguments"])
    write_json(out / REPLY_FILE, reply)


def _copy_packages(workspace: Workspace, source: Path, arguments: dict[str, Any]) -> None:
    """Copy a source tree, or the packages of a submission, to the workspace."""
    if source.is_dir():
        shutil.copytree(source, workspace.root / "src", ignore=course_paths.NOT_COPIED)
        return
    packages = intake.read_submission(source, arguments["assignment"]).packages
    if packages is None:
        raise StudentError(Diagnosis(Kind.NOTHING_SUBMITTED, NEEDS_NOTEBOOK))
    with reading("Your submission"):
        intake.write_tree(packages, workspace.root / "src")


def _drive(
    workspace: Workspace,
    out: Path,
    package: str,
    executable: str,
    simulation: str,
    seconds: float,
    options: list[str],
    parameter_file: str,
    published: dict[str, Any] | None,
) -> dict[str, Any]:
    from autograder.building.build import build_workspace
    from autograder.harness import SteppedHarness, drive
    from autograder.harness.drive import COMMAND_TOPICS, SENSOR_TOPICS
    from autograder.notebook.publishing import messages_at, types_of
    from sim import State
    from sim.codec import from_json

    plan = published or {"types": {}, "steps": []}
    types = types_of(plan)
    if parameter_file:
        path = workspace.scratch / "parameters.yaml"  # visible in the sandbox
        path.write_text(parameter_file)
        options += ["--params-file", str(path)]
    arguments = ("--ros-args", *options) if options else ()
    try:
        build_workspace(workspace, (package,))
        with SteppedHarness(
            workspace,
            package,
            executable,
            publishes={**SENSOR_TOPICS, **types},
            subscribes=COMMAND_TOPICS,
            arguments=arguments,
        ) as harness:

            def publish(state: State) -> bool:
                """Publish the messages that are planned for the end of this step. Never end the drive."""
                for topic, message in messages_at(plan, types, state.time_ns + harness.tick_ns).items():
                    harness.publish(topic, message)
                return False

            result = drive(harness, from_json(simulation), seconds, until=publish)
    except StudentError as error:
        return {"diagnosis": asdict(error.diagnosis)}
    result.recording.save(out / RECORDING)
    commands = [[c.seconds, c.message.linear.x, c.message.angular.z] for c in result.commands]
    return {"diagnosis": asdict(OK), "output": result.output, "commands": commands}


def _check(
    workspace: Workspace,
    out: Path,
    assignment: str,
    exercises: list[dict[str, Any]],
    part: str,
    first: list[str],
) -> dict[str, Any]:
    """Run the checks of a chapter, or of the exercise called `part`.

    The checks with ids in `first` run before the others, and their results are written to `out` immediately.
    """
    from autograder.building.build import build_workspace
    from autograder.building.colcon import StoppedBuildError
    from autograder.grade.job import Options
    from autograder.grade.plugin import GradingPlugin, run
    from autograder.notebook.exercises import Exercise, checks_of
    from autograder.result.artifacts import Artifacts
    from autograder.result.model import CheckResult
    from autograder.suite import Outcome, suites

    suite = suites.visible(assignment)
    all_exercises = [structure(Exercise, exercise) for exercise in exercises]
    matches = [exercise for exercise in all_exercises if exercise.name == part]
    selected_checks = (
        checks_of(matches[0], all_exercises, suite.checks) if matches else tuple(check.id for check in suite.checks)
    )
    results: dict[str, CheckResult] = {}

    def reply(reason: Diagnosis, ids: Collection[str], *, lasting: bool = True) -> dict[str, Any]:
        """Return a reply with the results of these checks, and of all checks that did not pass."""
        not_passed = {name for name, result in results.items() if result.outcome is not Outcome.PASSED}
        reported_checks = [check for check in suite.checks if check.id in ids or check.id in not_passed]
        lines = [results.get(check.id) or CheckResult.of(check, Outcome.NOT_CHECKED) for check in reported_checks]
        return {
            "diagnosis": asdict(reason),
            "checks": [asdict(line) for line in lines],
            "sources": suite.sources,
            "reads": suite.reads,
            "lasting": lasting,
        }

    early_checks = [name for name in selected_checks if name in first]
    other_checks = [name for name in selected_checks if name not in first]
    try:
        build = build_workspace(workspace, suite.packages, may_fail=suite.build_may_fail)
        diagnosis = build.diagnosis
        for ids in filter(None, (early_checks, other_checks)):
            is_whole_suite = len(ids) == len(suite.checks)
            options = Options(only=() if is_whole_suite else suite.with_dependencies(*ids))
            plugin = GradingPlugin(workspace, SEED, Artifacts(out), build.diagnoses, options)
            run(suite.files, plugin)
            if plugin.failures:
                raise GraderError("\n".join(plugin.failures))
            results |= plugin.results
            diagnosis = plugin.diagnosis if diagnosis is OK else diagnosis
            if ids is early_checks and other_checks:
                write_json(out / EARLY_FILE, reply(diagnosis, early_checks))
    except StudentError as error:
        return reply(error.diagnosis, selected_checks, lasting=not isinstance(error, StoppedBuildError))
    return reply(diagnosis, selected_checks)


VERBS: dict[str, Callable[..., dict[str, Any]]] = {"drive": _drive, "check": _check}

if __name__ == "__main__":
    main()
