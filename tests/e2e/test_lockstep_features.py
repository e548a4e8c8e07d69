"""Lockstep supports rclpy's features, such as services and actions, and gives the same run every time."""

from __future__ import annotations

import shutil
import sys
from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

from autograder.run.sandbox import Limits, Process
from tests.e2e import lockstep_programs as programs
from tests.e2e.sandbox_support import in_worker_sandbox

INTERFACES = {
    "action/Count.action": "int32 order\n---\nint32[] sequence\n---\nint32 last\n",
    "msg/Word.msg": "string text\n",
}


@lru_cache(maxsize=1)
def interfaces() -> Path:
    """Build the message package of these tests."""
    from autograder.building.interfaces.prefix import build

    return build("lockstep_interfaces", INTERFACES)


def write_workspace(scratch: Path, **texts: str) -> Any:
    """Write programs and the message package as a built workspace."""
    from autograder.harness import Workspace
    from autograder.ros import activate

    folder = scratch / "ws" / "install" / "pkg" / "lib" / "pkg"
    if not folder.is_dir():
        folder.mkdir(parents=True)
        (scratch / "home").mkdir()
        shutil.copytree(interfaces(), scratch / "ws" / "install" / "lockstep_interfaces")
    for name, text in texts.items():
        (folder / name).write_text(f"#!/usr/bin/env python3\n{programs.HEAD}{text}")
    return Workspace(scratch / "ws", activate(), scratch / "home")


def received(harness: Any, topic: str = "/said") -> list[Any]:
    """Return the time and text of each received message."""
    return [[round(stamped.seconds, 3), stamped.message.data] for stamped in harness.messages(topic)]


def same_result_twice(run: Any) -> Any:
    """Call a function twice, require the same result, and return it."""
    first, second = run(), run()
    assert first == second, f"{first}\n{second}"
    return first


def open_harness(workspace: Any, *names: str, real: bool = False, **options: Any) -> Any:
    """Return a harness with some of the programs, in lockstep or real time; the grader subscribes to /said."""
    from std_msgs.msg import String

    from autograder.harness import Program, RealTimeHarness, SteppedHarness

    subscribes = {"/said": String, **options.pop("subscribes", {})}
    kind = RealTimeHarness if real else SteppedHarness
    return kind(workspace, programs=tuple(Program("pkg", name) for name in names), subscribes=subscribes, **options)


def call_server(scratch: Path) -> Any:
    from rcl_interfaces.srv import GetParameters, SetParameters
    from rclpy.parameter import Parameter
    from std_srvs.srv import SetBool, Trigger

    workspace = write_workspace(scratch, node=programs.SERVER)

    def run() -> Any:
        with open_harness(workspace, "node") as harness:
            answers = [harness.call(Trigger, "/ask", Trigger.Request()).message]
            harness.run(0.3)
            answers.append(harness.call(Trigger, "/ask", Trigger.Request()).message)
            answers.append(harness.call(SetBool, "/ask", SetBool.Request(), seconds=0.2))
            answers.append(harness.call(Trigger, "/nobody", Trigger.Request(), seconds=0.2))
            for speed in (0.9, 9.0):
                request = SetParameters.Request(parameters=[Parameter("speed", value=speed).to_parameter_msg()])
                result = harness.call(SetParameters, "/server/set_parameters", request).results[0]
                answers.append([result.successful, result.reason])
            reply = harness.call(GetParameters, "/server/get_parameters", GetParameters.Request(names=["speed"]))
            return answers, reply.values[0].double_value, round(harness.seconds, 3), received(harness)

    return same_result_twice(run)


def test_services_and_parameter_services_answer_without_a_step_of_ros_time() -> None:
    answers, speed, seconds, messages = in_worker_sandbox(call_server)
    assert answers == ["1", "2", None, None, [True, ""], [False, "too fast"]]
    assert speed == 0.9
    assert seconds == pytest.approx(0.5)
    assert messages == [[0.0, "server asked 0.000"], [0.3, "server asked 0.300"]]


def run_with_arguments(scratch: Path) -> Any:
    from rcl_interfaces.srv import GetParameters

    from autograder.harness import RealTimeHarness, SteppedHarness

    workspace = write_workspace(scratch, node=programs.SERVER)
    arguments = ("--ros-args", "-r", "__node:=driver", "-p", "speed:=0.25")
    outcomes = []
    for kind in (SteppedHarness, RealTimeHarness):
        with kind(workspace, "pkg", "node", arguments=arguments) as harness:
            reply = harness.call(GetParameters, "/driver/get_parameters", GetParameters.Request(names=["speed"]))
            outcomes.append([harness.nodes(), reply.values[0].double_value])
    return outcomes


def test_a_program_gets_its_arguments_in_lockstep_and_in_real_time() -> None:
    assert in_worker_sandbox(run_with_arguments) == [[["/driver"], 0.25]] * 2


def send_goals(scratch: Path, program: str) -> Any:
    from autograder.building.interfaces.loading import classes

    count = classes((("lockstep_interfaces", tuple(INTERFACES.items())),)).action.Count
    workspace = write_workspace(scratch, node=program)

    def run() -> Any:
        with open_harness(workspace, "node") as harness:
            short = harness.send_goal(count, "/count", count.Goal(order=3))
            is_finished = harness.until(lambda: short.result is not None, 3.0)
            rejected = harness.send_goal(count, "/count", count.Goal(order=99))
            harness.until(lambda: rejected.accepted is not None, 1.0)
            long = harness.send_goal(count, "/count", count.Goal(order=40))
            harness.run(0.35)
            long.cancel()
            harness.until(lambda: long.result is not None, 20.0)
            feedback = [[round(f.seconds, 3), f.message.last] for f in short.feedback]
            outcomes = [[goal.accepted, goal.status] for goal in (short, rejected, long)]
            return [is_finished, outcomes, list(short.result.sequence), feedback, len(long.feedback), long.cancelled]

    return same_result_twice(run)


@pytest.mark.parametrize("name", programs.ACTION_SERVERS)
def test_an_action_gives_feedback_and_a_result_in_ros_time(name: str) -> None:
    is_finished, outcomes, sequence, feedback, feedback_before_cancel, cancelled = in_worker_sandbox(
        send_goals, programs.ACTION_SERVERS[name]
    )
    assert is_finished
    assert sequence == [0, 1, 2]
    assert [value for _, value in feedback] == [0, 1, 2]
    assert outcomes[:2] == [[True, 4], [False, 0]]
    times = [seconds - feedback[0][0] for seconds, _ in feedback]
    if "in many threads" in name:
        assert times == pytest.approx([0.0, 0.1, 0.2])
        assert (outcomes[2], cancelled) == ([True, 5], True)
        assert feedback_before_cancel == 3
    elif "synchronous" in name and "asynchronous" not in name:
        assert times == pytest.approx([0.0, 0.2, 0.4])
        assert feedback_before_cancel == 40  # its only thread was busy, so nothing could handle the cancel request
    else:
        assert times == [0.0, 0.0, 0.0]


def run_clients(scratch: Path) -> Any:
    workspace = write_workspace(scratch, server=programs.SERVER)

    def run(name: str) -> Any:
        with open_harness(workspace, "node", "server") as harness:
            harness.run(1.6)
            return [[seconds, text] for seconds, text in received(harness) if not text.startswith("server")]

    received_by_client = {}
    for name, text in programs.CLIENTS.items():
        write_workspace(scratch, node=text)
        received_by_client[name] = same_result_twice(lambda name=name: run(name))
    return received_by_client


def test_a_client_gets_its_responses_at_once_however_it_waits() -> None:
    received_by_client = in_worker_sandbox(run_clients)
    for name, messages in received_by_client.items():
        times = [0.5, 0.5, 1.0, 1.0, 1.5, 1.5] if name == "await" else [0.5, 1.0, 1.5]
        if name == "spin_until_future_complete":
            times = [0.1, 0.6, 1.1, 1.6]
            assert [text.split()[:3] for _, text in messages] == [["asking", "got", str(n + 1)] for n in range(4)], name
            continue
        assert messages == [[t, f"asking got {n} {t:.3f}"] for n, t in enumerate(times, 1)], name


def run_late_server(scratch: Path) -> Any:
    workspace = write_workspace(scratch, node=programs.WAITING_CLIENT, server=programs.LATE_SERVER)

    def run() -> Any:
        with open_harness(workspace, "node", "server") as harness:
            harness.run(0.4)
            return received(harness)

    return same_result_twice(run)


def test_a_service_that_is_created_later_is_available_from_the_next_step() -> None:
    assert [text for _, text in in_worker_sandbox(run_late_server)] == [
        "patient nobody 0.100",
        "patient nobody 0.200",
        "patient got 1 0.300",
        "patient got 2 0.400",
    ]


def run_client_with_timeout(scratch: Path) -> Any:
    workspace = write_workspace(scratch, node=programs.CLIENT_WITH_TIMEOUT, server=programs.BUSY_SERVER)

    def run() -> Any:
        with open_harness(workspace, "node", "server") as harness:
            harness.run(1.2)
            return received(harness)

    return same_result_twice(run)


def test_a_timeout_is_counted_in_ros_time_exact_to_the_tick() -> None:
    messages = in_worker_sandbox(run_client_with_timeout)
    assert [text.split()[1:3] for _, text in messages] == [["no", "answer"]] * 3
    assert [seconds for seconds, _ in messages] == pytest.approx([0.35, 0.7, 1.05], abs=0.011)


def run_alone(scratch: Path, text: str, seconds: float) -> Any:
    from std_msgs.msg import String

    workspace = write_workspace(scratch, node=text)

    def run() -> Any:
        with open_harness(workspace, "node", subscribes={"/also": String, "/map": String}) as harness:
            harness.run(seconds)
            return [received(harness), received(harness, "/also"), received(harness, "/map"), harness.notes]

    return same_result_twice(run)


def test_timers_can_be_created_late_cancelled_and_reset() -> None:
    messages, repeated, _, _ = in_worker_sandbox(run_alone, programs.TIMERS, 1.3)
    texts = [text.rsplit(" ", 1)[0].split()[1] for _, text in messages]
    assert [s for (s, _), text in zip(messages, texts, strict=True) if text == "tick"] == [0.4, 0.8, 1.2]
    assert [s for (s, _), text in zip(messages, texts, strict=True) if text == "shot"] == [0.3, 1.1]
    late_times = [s for (s, _), text in zip(messages, texts, strict=True) if text == "late"]
    assert late_times == [0.45, 0.5, 0.55, 0.6, 0.65, 0.7, 0.75]
    assert repeated == [[0.8, "tick"], [1.2, "tick"]]


def test_the_wall_clock_and_sleep_follow_ros_time() -> None:
    messages, _, _, notes = in_worker_sandbox(run_alone, programs.WALL_CLOCK, 0.6)
    assert not notes
    assert messages[:4] == [
        [0.1, "wall 0.10 0.10 0.100"],
        [0.25, "wall slept 0.250"],
        [0.25, "wall 0.25 0.25 0.250"],
        [0.4, "wall slept 0.400"],
    ]


@pytest.mark.parametrize("program", ["OWN_CONTEXT", "EVENTS_EXECUTOR"])
def test_a_program_with_its_own_context_or_executor_is_stepped(program: str) -> None:
    messages, _, _, notes = in_worker_sandbox(run_alone, getattr(programs, program), 0.35)
    assert not notes
    assert messages == [[0.1, "tick"], [0.2, "tick"], [0.3, "tick"]]


def test_sleeping_on_a_clock_lets_ros_time_pass() -> None:
    messages, _, _, notes = in_worker_sandbox(run_alone, programs.CLOCK_SLEEPS, 1.5)
    assert not notes
    assert [seconds for seconds, _ in messages] == pytest.approx([0.35, 0.6, 0.85, 1.1, 1.1], abs=0.011)
    assert [text.split(maxsplit=1)[1].rsplit(" ", 1)[0] for _, text in messages] == [
        *["True"] * 4,
        "until's clock type does not match this clock's type",
    ]


def test_nodes_of_one_program_exchange_messages_within_a_step() -> None:
    messages, _, _, _ = in_worker_sandbox(run_alone, programs.TWO_NODES, 0.3)
    texts = ["heard why 0", "got {n}", "heard why 1", "heard why 2"]
    for n, seconds in enumerate((0.1, 0.2, 0.3), 1):
        texts_at_once = sorted(
            text.removeprefix("asker ").removesuffix(f" {seconds:.3f}") for s, text in messages if s == seconds
        )
        assert texts_at_once == sorted(text.format(n=n) for text in texts)


def run_together(scratch: Path, texts: dict[str, str], seconds: float) -> Any:
    from std_msgs.msg import String

    workspace = write_workspace(scratch, **texts)

    def run() -> Any:
        with open_harness(workspace, *texts, subscribes={"/map": String, "/ping": String}) as harness:
            harness.run(seconds)
            return [received(harness), received(harness, "/map"), received(harness, "/ping")]

    return same_result_twice(run)


def test_a_transient_local_message_reaches_a_late_subscription() -> None:
    messages, maps, _ = in_worker_sandbox(run_together, {"map": programs.MAP, "reader": programs.MAP_READER}, 0.2)
    assert messages == [[0.1, "reader read map 0.100"]]
    assert [text for _, text in maps] == ["map"]


def pong(following: str, qos: str) -> dict[str, str]:
    return {"pinger": programs.PINGER, "ponger": programs.PONGER.replace("{next}", following).replace("{qos}", qos)}


def test_programs_answer_each_other_within_a_step_until_no_message_is_left() -> None:
    messages, _, pings = in_worker_sandbox(run_together, pong("int(m.data) - 1", "10"), 0.3)
    assert messages == [[s, f"pinger hit {n} {s:.3f}"] for s in (0.1, 0.2, 0.3) for n in (4, 3, 2, 1, 0)]
    assert pings == [[s, str(n)] for s in (0.1, 0.2, 0.3) for n in (5, 4, 3, 2, 1)]


def test_endpoints_with_incompatible_quality_of_service_are_not_waited_for() -> None:
    best_effort = "'ping', QoSProfile(depth=10, reliability=ReliabilityPolicy.BEST_EFFORT)"
    pinger = programs.PINGER.replace("'ping', 10", best_effort)
    messages, _, pings = in_worker_sandbox(
        run_together, {"pinger": pinger, "ponger": pong("int(m.data) - 1", "10")["ponger"]}, 0.3
    )
    assert messages == []
    assert len(pings) == 3


def test_programs_exchange_messages_of_a_type_that_the_grader_does_not_know() -> None:
    texts = {"listener": programs.CUSTOM_TYPE_LISTENER, "talker": programs.CUSTOM_TYPE_SPEAKER}
    messages, _, _ = in_worker_sandbox(run_together, texts, 0.3)
    assert messages == [[s, f"listener hello {s:.3f}"] for s in (0.1, 0.2, 0.3)]


def receive_forged_messages(scratch: Path) -> Any:
    from autograder.building.interfaces.loading import classes

    word = classes((("lockstep_interfaces", tuple(INTERFACES.items())),)).msg.Word
    workspace = write_workspace(scratch, talker=programs.FORGED_WORDS)

    def run() -> Any:
        with open_harness(workspace, "talker", subscribes={"/words": word}) as harness:
            harness.run(0.3)
            return [
                [round(received_message.seconds, 3), received_message.message.text]
                for received_message in harness.messages("/words")
            ]

    return same_result_twice(run)


def test_bytes_that_are_not_a_message_of_their_type_are_dropped_and_counted() -> None:
    assert in_worker_sandbox(receive_forged_messages) == [[s, "hello"] for s in (0.1, 0.2, 0.3) for _ in range(5)]


def run_with_and_without_load(scratch: Path) -> Any:
    texts = {"server": programs.SERVER, "first": programs.CLIENTS["await"]}
    texts["second"] = programs.CLIENTS["call in many threads"].replace("'asking'", "'second'")
    workspace = write_workspace(scratch, **texts)
    busy = [Process([sys.executable, "-I", "-c", "while True: pass"], Limits(wall_seconds=120)) for _ in range(2)]

    def run() -> Any:
        with open_harness(workspace, *texts) as harness:
            harness.run(1.0)
            return received(harness)

    quiet = run()
    try:
        loaded = run()
    finally:
        for process in busy:
            process.kill()
    return [quiet, loaded]


def test_clients_of_two_programs_share_a_service_and_a_busy_machine_changes_nothing() -> None:
    quiet, loaded = in_worker_sandbox(run_with_and_without_load)
    assert quiet == loaded
    numbers = sorted(int(text.split()[2]) for _, text in quiet if " got " in text)
    assert numbers == [1, 2, 3, 4, 5, 6]


def diagnose(scratch: Path, texts: dict[str, str]) -> list[str]:
    from autograder.exceptions import StudentError

    workspace = write_workspace(scratch, **texts)
    try:
        with open_harness(workspace, *texts) as harness:
            harness.run(2.0)
    except StudentError as error:
        return [error.diagnosis.kind.value, error.diagnosis.sentence]
    return ["ok", ""]


@pytest.mark.parametrize("name", programs.DEADLOCKS)
def test_a_deadlock_is_reported_at_once_with_its_reason(name: str) -> None:
    text, words = programs.DEADLOCKS[name]
    kind, sentence = in_worker_sandbox(diagnose, {"node": text, "server": programs.SERVER})
    assert kind == "stuck"
    assert words in sentence


def test_programs_that_answer_each_other_without_end_are_stopped() -> None:
    kind, sentence = in_worker_sandbox(diagnose, pong("int(m.data)", "10"))
    assert kind == "stuck"
    assert "would continue for ever" in sentence


def run_flood(scratch: Path, text: str) -> list[Any]:
    """Return the messages that the grader received from a program in half a second."""
    with open_harness(write_workspace(scratch, node=text), "node") as harness:
        harness.run(0.5)
        return received(harness)


def test_a_program_that_floods_discovery_is_reported() -> None:
    _, sentence = in_worker_sandbox(diagnose, {"node": programs.FLOODS["3,000 topics"]})
    assert "more nodes, topics, services or timers" in sentence


@pytest.mark.parametrize("name", ["100 kHz", "100,000 at once"])
def test_the_grader_drops_the_messages_of_a_flood_that_exceed_its_queue(name: str) -> None:
    messages = in_worker_sandbox(run_flood, programs.FLOODS[name])
    assert {text for _, text in messages} == {"x"}
    assert len(messages) < 20_000


def test_the_grader_serves_no_parameters_that_a_program_could_set() -> None:
    assert [text for _, text in in_worker_sandbox(run_flood, programs.FLOODS["the grader's parameters"])] == [
        "ready: False"
    ] * 5


def test_the_crashing_program_among_several_is_named() -> None:
    texts = {"server": programs.SERVER, "broken": "raise ValueError('no lidar')"}
    kind, sentence = in_worker_sandbox(diagnose, texts)
    assert kind == "crashed_at_import"
    assert sentence.startswith("broken: Your module could not be imported: ValueError: no lidar")


def run_with_optional_program(scratch: Path, text: str) -> Any:
    from std_srvs.srv import Trigger

    from autograder.exceptions import StudentError

    workspace = write_workspace(scratch, server=programs.SERVER, map=programs.MAP, optional=text)

    def run() -> Any:
        harness = open_harness(workspace, "server", "optional", "map")
        harness.optional = frozenset({"optional"})
        with harness:
            harness.run(0.5)
            answer = harness.call(Trigger, "/ask", Trigger.Request()).message
            running_names = sorted(harness.running)
            harness.optional = frozenset()
            try:
                harness.run(0.5)
            except StudentError as error:
                return [answer, running_names, error.diagnosis.sentence]
            return [answer, running_names, ""]

    return same_result_twice(run)


CRASHING = """
class Listener(Speaker):
    def __init__(self):
        super().__init__('listener')
        self.create_subscription(String, 'map', self.read, LATCHED)
        self.create_timer({period}, self.fail)

    def read(self, message):
        {reading}

    def fail(self):
        raise ValueError('out of range')

spin(Listener)
"""


@pytest.mark.parametrize(
    "text",
    [
        "raise ValueError('no lidar')",
        CRASHING.format(period=60.0, reading="raise ValueError('no map')"),
        CRASHING.format(period=0.2, reading="pass"),
    ],
    ids=["at the start", "at a message", "at a timer"],
)
def test_other_programs_continue_if_an_optional_program_ends(text: str) -> None:
    assert in_worker_sandbox(run_with_optional_program, text) == ["1", ["map", "server"], ""]


def test_the_crash_of_an_optional_program_is_named_once_the_program_is_required() -> None:
    answer, running_names, sentence = in_worker_sandbox(
        run_with_optional_program, CRASHING.format(period=0.7, reading="pass")
    )
    assert (answer, running_names) == ("1", ["map", "optional", "server"])
    assert sentence.startswith("optional: ")
    assert "out of range" in sentence


def run_with_optional_program_in_real_time(scratch: Path, text: str) -> Any:
    from std_srvs.srv import Trigger

    from autograder.exceptions import StudentError

    workspace = write_workspace(scratch, server=programs.SERVER, map=programs.MAP, optional=text)
    harness = open_harness(workspace, "server", "optional", "map", real=True)
    harness.optional = frozenset({"optional"})
    with harness:
        harness.until(lambda: "optional" not in harness.running, 10.0)
        answer, running_names = harness.call(Trigger, "/ask", Trigger.Request()).message, sorted(harness.running)
    try:
        with open_harness(workspace, "server", "optional", "map", real=True) as harness:
            harness.run(10.0)
    except StudentError as error:
        return [answer, running_names, error.diagnosis.sentence]
    return [answer, running_names, ""]


@pytest.mark.parametrize(
    "text", ["raise ValueError('out of range')", CRASHING.format(period=0.7, reading="pass")], ids=["start", "timer"]
)
def test_in_real_time_other_programs_continue_and_a_required_program_that_fails_is_named(text: str) -> None:
    answer, running_names, sentence = in_worker_sandbox(run_with_optional_program_in_real_time, text)
    assert (answer, running_names) == ("1", ["map", "server"])
    assert sentence.startswith("optional: ")
    assert "out of range" in sentence
