"""Each verb of the `ros2` command against real nodes, as a user types it."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml

from autograder.ros import activate

ARENA = Path(__file__).with_name("ros2_arena.py")
ROS2 = [sys.executable, "-m", "autograder.ros.ros2"]
# Far above what a loaded machine needs: a command that hangs must end the test.
PATIENCE = 120.0
# Verbs that list everything have no condition to wait for, so they wait long enough for a busy machine; side by side.
LISTS = (
    "node list",
    "node list -c",
    "topic list -t",
    "topic list --include-hidden-topics",
    "topic list -c",
    "topic list -v",
    "topic find std_msgs/msg/String",
    "service list -t",
    "service find std_srvs/srv/SetBool",
    "action list -t",
    "param list --param-type --filter use_",
    "doctor",
    "wtf --include-warnings",
    "doctor --report",
)
SETTLE = ("--spin-time", "8")
# For verbs that wait for something which is there; and for something which is not.
WAIT = ("--spin-time", "60")
BRIEF = ("--spin-time", "0.3")

COUNT_ACTION = """int32 target
---
int32 total
---
int32 now
"""
CMAKELISTS = """cmake_minimum_required(VERSION 3.10)
project(arena_interfaces)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} "action/Count.action")
ament_package()
"""
PACKAGE_XML = """<package format="3">
  <name>arena_interfaces</name>
  <version>1.0.0</version>
  <description>An action to try the command on</description>
  <maintainer email="test@example.com">Test</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <depend>action_msgs</depend>
  <exec_depend>rosidl_default_runtime</exec_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
  <export><build_type>ament_cmake</build_type></export>
</package>
"""


@dataclass
class Answer:
    """What a command printed and how it ended."""

    out: str
    err: str
    code: int

    @property
    def lines(self) -> list[str]:
        return self.out.splitlines()


@dataclass
class Arena:
    """Running nodes, and the environment in which commands hear them."""

    env: dict[str, str]
    process: subprocess.Popen[str]

    def ros2(self, *words: str, stdin: str = "") -> Answer:
        """Run a command to its end; one that hangs is told to print where (`PYTHONFAULTHANDLER`) and to end."""
        env = {**self.env, "PYTHONFAULTHANDLER": "1"}
        with subprocess.Popen(
            [*ROS2, *words],
            env=env,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
            text=True,
        ) as process:
            try:
                out, err = process.communicate(stdin, timeout=PATIENCE)
            except subprocess.TimeoutExpired:
                process.send_signal(signal.SIGABRT)
                out, err = process.communicate()
                raise AssertionError(f"ros2 {' '.join(words)} hung\n{out}\n{err}") from None
        return Answer(out, err, process.returncode)

    def ask(self, *words: str) -> Answer:
        """Run a command about something that is there, however long a busy machine takes to discover it."""
        return self.ros2(*words, *WAIT)

    def together(self, *commands: tuple[str, ...]) -> list[Answer]:
        """Run commands side by side, as most of their time is waiting; return the answers in the same order."""
        with ThreadPoolExecutor(len(commands)) as pool:
            return list(pool.map(lambda words: self.ros2(*words), commands))

    def start(self, *words: str) -> subprocess.Popen[str]:
        """Start a command that goes on until it is interrupted."""
        return subprocess.Popen(
            [*ROS2, *words], env=self.env, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )

    def until(self, *words: str, seen: Callable[[str], bool], number: int = signal.SIGINT) -> Answer:
        """Run a command until a line of its output is `seen`, then signal it; return all it printed."""
        with self.start(*words) as process:
            assert process.stdout is not None
            lines = []
            for line in process.stdout:
                lines.append(line)
                if seen(line):
                    process.send_signal(number)
                    break
            try:
                rest, err = process.communicate(timeout=PATIENCE)
            finally:
                process.kill()
        return Answer("".join(lines) + rest, err, process.returncode)


def colcon(workspace: Path, *words: str) -> subprocess.CompletedProcess[str]:
    """Run colcon of this environment in a workspace."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    return subprocess.run(
        [sys.executable, "-m", "colcon", *words],
        cwd=workspace,
        env={**os.environ, "PATH": path, "MAKEFLAGS": "-j3"},
        capture_output=True,
        text=True,
        timeout=2 * PATIENCE,
    )


def overlay_env(install: Path) -> dict[str, str]:
    """Return what sourcing a merged install's setup.bash would set."""
    python = install / f"lib/python{sys.version_info[0]}.{sys.version_info[1]}/site-packages"
    return {
        **os.environ,
        **activate().variables(overlays=(install,)),
        "PYTHONPATH": str(python),
        "LD_LIBRARY_PATH": os.pathsep.join([str(install / "lib"), os.environ.get("LD_LIBRARY_PATH", "")]),
    }


@pytest.fixture(scope="module")
def arena(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Arena]:
    """Build an action, start the nodes, and end them after the last test."""
    workspace = tmp_path_factory.mktemp("arena")
    package = workspace / "src" / "arena_interfaces"
    (package / "action").mkdir(parents=True)
    (package / "action" / "Count.action").write_text(COUNT_ACTION)
    (package / "CMakeLists.txt").write_text(CMAKELISTS)
    (package / "package.xml").write_text(PACKAGE_XML)
    built = colcon(workspace, "build", "--merge-install")
    assert built.returncode == 0, built.stdout + built.stderr
    env = overlay_env(workspace / "install")
    with subprocess.Popen([sys.executable, str(ARENA)], env=env, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "ready\n"
        try:
            yield Arena(env, process)
            process.terminate()
            process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert process.returncode == 0


@pytest.fixture(scope="module")
def lists(arena: Arena) -> dict[str, Answer]:
    """Run all verbs that list everything; return what each said."""
    answers = arena.together(*((*words.split(), *SETTLE) for words in LISTS))
    return dict(zip(LISTS, answers, strict=True))


def test_node_list_shows_the_nodes_and_not_its_own(lists: dict[str, Answer]) -> None:
    assert lists["node list"].lines == ["/lab/helper", "/talker"]
    assert lists["node list -c"].lines == ["2"]


def test_node_info_lists_both_ends_of_everything(arena: Arena) -> None:
    answer = arena.ask("node", "info", "/lab/helper")
    assert answer.code == 0
    assert answer.lines[0] == "/lab/helper"
    headings = [line.strip() for line in answer.lines if re.fullmatch(r"  [A-Z].*:", line)]
    assert headings == [
        "Subscribers:", "Publishers:", "Service Servers:", "Service Clients:", "Action Servers:", "Action Clients:"
    ]  # fmt: skip
    assert "    /lab/cmd_vel: geometry_msgs/msg/Twist" in answer.lines
    assert "    /lab/switch: std_srvs/srv/SetBool" in answer.lines
    assert "    /lab/count: arena_interfaces/action/Count" in answer.lines


def test_node_info_of_a_stranger_fails(arena: Arena) -> None:
    answer = arena.ros2("node", "info", "/nobody", *BRIEF)
    assert (answer.code, answer.err) == (1, "Unable to find node '/nobody'\n")


def test_topic_list_with_types_and_count(lists: dict[str, Answer]) -> None:
    assert lists["topic list -t"].lines == [
        "/chatter [std_msgs/msg/String]",
        "/lab/cmd_vel [geometry_msgs/msg/Twist]",
        "/parameter_events [rcl_interfaces/msg/ParameterEvent]",
        "/robot_description [std_msgs/msg/String]",
        "/rosout [rcl_interfaces/msg/Log]",
        "/scan [sensor_msgs/msg/LaserScan]",
    ]
    assert "/_hidden" in lists["topic list --include-hidden-topics"].lines
    assert lists["topic list -c"].lines == ["6"]


def test_topic_list_verbose_sorts_by_publishers_and_subscribers(lists: dict[str, Answer]) -> None:
    published, subscribed = lists["topic list -v"].out.split("\n\n")[:2]
    assert published.startswith("Published topics:\n")
    assert " * /chatter [std_msgs/msg/String] 1 publisher" in published.splitlines()
    assert subscribed.startswith("Subscribed topics:\n")
    assert " * /lab/cmd_vel [geometry_msgs/msg/Twist] 1 subscriber" in subscribed.splitlines()


def test_topic_info_counts_both_ends(arena: Arena) -> None:
    short, verbose = arena.together(
        ("topic", "info", "/chatter", *WAIT), ("topic", "info", "-v", "/lab/cmd_vel", *WAIT)
    )
    assert short.lines == ["Type: std_msgs/msg/String", "Publisher count: 1", "Subscription count: 0"]
    assert "Subscription count: 1\n\nNode name: helper\nNode namespace: /lab\n" in verbose.out
    assert "  Reliability: RELIABLE" in verbose.out


def test_topic_info_of_an_unknown_topic_fails(arena: Arena) -> None:
    answer = arena.ros2("topic", "info", "/nothing", *BRIEF)
    assert (answer.code, answer.err) == (1, "Unknown topic '/nothing'\n")


def test_topic_type_and_find(arena: Arena, lists: dict[str, Answer]) -> None:
    assert arena.ask("topic", "type", "/scan").out == "sensor_msgs/msg/LaserScan\n"
    assert lists["topic find std_msgs/msg/String"].lines == ["/chatter", "/robot_description"]
    unknown = arena.ros2("topic", "type", "/nothing", *BRIEF)
    assert (unknown.code, unknown.out) == (1, "")


def test_topic_echo_prints_yaml_until_interrupted(arena: Arena) -> None:
    answer = arena.until("topic", "echo", "/chatter", seen=lambda line: line == "---\n")
    assert re.match(r"data: hello \d+\n---\n", answer.out)
    assert (answer.code, answer.err) == (2, "")


def test_topic_echo_ends_on_sigterm(arena: Arena) -> None:
    answer = arena.until("topic", "echo", "/chatter", seen=lambda line: line == "---\n", number=signal.SIGTERM)
    assert (answer.code, answer.err) == (15, "")


def test_topic_echo_truncates_long_arrays_and_selects_fields(arena: Arena) -> None:
    echo = ("topic", "echo", "/scan", "--once", *WAIT)
    cut, full, field, summary, wrong = arena.together(
        echo,
        (*echo, "--full-length"),
        (*echo, "--field", "range_max"),
        (*echo, "--no-arr"),
        (*echo, "--field", "speed"),
    )
    assert cut.out.count("- 1.0\n") == 128
    assert "- '...'\n" in cut.out
    assert yaml.safe_load(full.out.removesuffix("---\n"))["ranges"] == [1.0] * 200
    assert field.out == "8.0\n---\n"
    assert "ranges: '<sequence type: float, length: 200>'\n" in summary.out
    assert wrong.code == 1
    assert wrong.err.startswith("Invalid field 'speed': 'LaserScan' object has no attribute 'speed'")


def test_topic_echo_filters_and_writes_csv(arena: Arena) -> None:
    even = arena.ask("topic", "echo", "/chatter", "--once", "--csv", "--filter", "int(m.data.split()[1]) % 7 == 0")
    assert re.fullmatch(r"hello \d+\n", even.out)
    assert int(even.out.split()[1]) % 7 == 0


def test_topic_echo_hears_what_was_latched_before_it_came(arena: Arena) -> None:
    assert arena.ask("topic", "echo", "/robot_description", "--once").out == "data: a robot\n---\n"


def test_topic_echo_of_a_silent_topic_times_out_and_of_an_unknown_one_fails(arena: Arena) -> None:
    silent = arena.ask("topic", "echo", "/lab/cmd_vel", "--timeout", "0.5")
    assert (silent.code, silent.out) == (0, "")
    unknown = arena.ros2("topic", "echo", "/nothing", *BRIEF)
    assert (unknown.code, unknown.err) == (1, "Could not determine the type for the passed topic\n")
    assert unknown.out == "WARNING: topic [/nothing] does not appear to be published yet\n"


def test_topic_pub_once_waits_for_the_listener(arena: Arena) -> None:
    # The publisher may see the listener before the listener sees it; a reliable message is then sent again, as long as
    # the publisher lives.
    reliable = ("--qos-reliability", "reliable")
    with arena.start("topic", "echo", "--once", *reliable, "/told", "geometry_msgs/msg/TwistStamped") as listener:
        values = "{header: {stamp: now, frame_id: base}, twist: {linear: {x: 0.5}}}"
        told = arena.ros2(
            "topic", "pub", "--once", "--keep-alive", "10", "/told", "geometry_msgs/msg/TwistStamped", values
        )
        heard, _ = listener.communicate(timeout=PATIENCE)
    assert told.code == 0
    assert "publisher: beginning loop\npublishing #1: geometry_msgs.msg.TwistStamped(" in told.out
    message = yaml.safe_load(heard.removesuffix("---\n"))
    assert message["twist"]["linear"] == {"x": 0.5, "y": 0.0, "z": 0.0}
    assert message["header"]["frame_id"] == "base"
    assert message["header"]["stamp"]["sec"] > 0


def test_topic_pub_goes_on_at_its_rate_until_interrupted(arena: Arena) -> None:
    words = ("topic", "pub", "-r", "20", "-p", "2", "/told_often", "std_msgs/msg/Int32", "data: 7")
    answer = arena.until(*words, seen=lambda line: "#4" in line)
    assert re.findall(r"publishing #(\d+): std_msgs.msg.Int32\(data=7\)", answer.out)[:2] == ["2", "4"]
    assert answer.code == 2


@pytest.mark.parametrize(
    ("words", "error"),
    [
        (("std_msgs/msg/Nothing", "{}"), "The passed message type is invalid: 'std_msgs/msg/Nothing'"),
        (("std_msgs/msg/String", "{dat: 1}"), "Failed to populate field: 'String' object has no attribute 'dat'"),
        (("std_msgs/msg/String", "hello"), "The passed value needs to be a dictionary in YAML format"),
        (("std_msgs/msg/String", "{data: ["), "The passed value is not valid YAML"),
        (("std_msgs/msg/Int32", "data: many"), "Failed to populate field: invalid literal for int()"),
    ],
)
def test_topic_pub_says_what_is_wrong_with_a_message(arena: Arena, words: tuple[str, str], error: str) -> None:
    answer = arena.ros2("topic", "pub", "--once", "/told", *words)
    assert answer.code == 1
    assert answer.err.startswith(error)


def test_topic_pub_gives_up_waiting_when_asked_to(arena: Arena) -> None:
    answer = arena.ros2("topic", "pub", "--once", "--max-wait-time-secs", "0.2", "/alone", "std_msgs/msg/Empty")
    assert answer.code == 1
    assert answer.out == "Waiting for at least 1 matching subscription(s)...\n"
    assert answer.err.startswith("Timed out waiting for subscribers: Expected 1 subcribers but only got 0")


def test_topic_hz_measures_the_talker(arena: Arena) -> None:
    answer = arena.until("topic", "hz", "/chatter", seen=lambda line: "std dev" in line)
    found = re.search(
        r"average rate: ([\d.]+)\n\tmin: [\d.]+s max: [\d.]+s std dev: [\d.]+s window: (\d+)\n", answer.out
    )
    assert found is not None
    # 20 Hz; a loaded machine may make it slower, never much faster.
    assert 1 < float(found[1]) < 30
    assert int(found[2]) > 1


def test_topic_bw_measures_the_size_of_messages(arena: Arena) -> None:
    answer = arena.until("topic", "bw", "/scan", seen=lambda line: "Message size" in line)
    assert answer.lines[0] == "Subscribed to [/scan]"
    assert re.search(
        r"[\d.]+ KB/s from \d+ messages\n\tMessage size mean: 0.8\d KB min: 0.8\d KB max: 0.8\d KB", answer.out
    )


def test_service_list_type_find_and_info(arena: Arena, lists: dict[str, Answer]) -> None:
    listed = lists["service list -t"].lines
    assert "/lab/switch [std_srvs/srv/SetBool]" in listed
    assert not [line for line in listed if "/_action/" in line]
    assert lists["service find std_srvs/srv/SetBool"].out == "/lab/switch\n"
    kind, info = arena.together(("service", "type", "/lab/switch", *WAIT), ("service", "info", "/lab/switch", *WAIT))
    assert kind.out == "std_srvs/srv/SetBool\n"
    assert info.lines == [
        "Type: std_srvs/srv/SetBool", "Clients count: 0", "Services count: 1"
    ]  # fmt: skip


def test_service_call_prints_request_and_response(arena: Arena) -> None:
    answer = arena.ros2("service", "call", "/lab/switch", "std_srvs/srv/SetBool", "{data: true}")
    assert answer.code == 0
    assert answer.out.removeprefix("waiting for service to become available...\n") == (
        "requester: making request: std_srvs.srv.SetBool_Request(data=True)\n\n"
        "response:\nstd_srvs.srv.SetBool_Response(success=True, message='switched on')\n\n"
    )
    wrong = arena.ros2("service", "call", "/lab/switch", "std_srvs/srv/Nothing")
    assert wrong.code == 1
    assert wrong.err.startswith("The passed service type is invalid: 'std_srvs/srv/Nothing'")


def test_action_list_info_and_type(arena: Arena, lists: dict[str, Answer]) -> None:
    info, kind = arena.together(("action", "info", "-t", "/lab/count", *WAIT), ("action", "type", "/lab/count", *WAIT))
    assert lists["action list -t"].out == "/lab/count [arena_interfaces/action/Count]\n"
    assert info.lines == [
        "Action: /lab/count",
        "Action clients: 0",
        "Action servers: 1",
        "    /lab/helper [arena_interfaces/action/Count]",
    ]
    assert kind.out == "arena_interfaces/action/Count\n"


def test_action_send_goal_prints_feedback_and_result(arena: Arena) -> None:
    answer = arena.ros2("action", "send_goal", "-f", "/lab/count", "arena_interfaces/action/Count", "{target: 3}")
    assert answer.code == 0
    feedback = r"Feedback:\n    now: (\d)\n\n"
    # The result does not wait for feedback that is still on its way, so the last ones may be missing.
    heard = re.findall(feedback, answer.out)
    assert heard
    assert heard == ["1", "2", "3"][: len(heard)]
    assert re.sub(r"[0-9a-f]{32}", "ID", re.sub(feedback, "", answer.out)) == (
        "Waiting for an action server to become available...\nSending goal:\n     target: 3\n\n"
        "Goal accepted with ID: ID\n\nResult:\n    total: 6\n\nGoal finished with status: SUCCEEDED\n"
    )


def test_action_send_goal_reports_a_rejection(arena: Arena) -> None:
    answer = arena.ros2("action", "send_goal", "/lab/count", "arena_interfaces/action/Count", "{target: -1}")
    assert answer.lines[-1] == "Goal was rejected."


def test_interrupting_send_goal_cancels_the_goal(arena: Arena) -> None:
    words = ("action", "send_goal", "/lab/count", "arena_interfaces/action/Count", "{target: 1000}")
    answer = arena.until(*words, seen=lambda line: line.startswith("Goal accepted"))
    assert answer.code == 2
    assert answer.out.endswith("Canceling goal...\nGoal canceled.\n")
    assert arena.process.stdout is not None
    assert arena.process.stdout.readline() == "cancelled\n"


def test_param_list_of_one_node_and_of_all(arena: Arena, lists: dict[str, Answer]) -> None:
    one = arena.ask("param", "list", "/lab/helper").lines
    assert {"  speed", "  ids", "  filter.window", "  use_sim_time"} <= set(one)
    assert lists["param list --param-type --filter use_"].lines == [
        "/lab/helper:", "  use_sim_time (type: boolean)", "/talker:", "  use_sim_time (type: boolean)"
    ]  # fmt: skip


def test_param_get_names_the_type(arena: Arena) -> None:
    printed = {
        "speed": "Double value is: 1.0\n",
        "frozen": "String value is: yes\n",
        "use_sim_time": "Boolean value is: False\n",
        "ids": "Integer values are: array('q', [1, 2, 3])\n",
    }
    answers = arena.together(*(("param", "get", "/lab/helper", name, *WAIT) for name in printed))
    assert [answer.out for answer in answers] == list(printed.values())


def test_param_get_of_what_is_not_there_fails(arena: Arena) -> None:
    unset = arena.ask("param", "get", "/lab/helper", "nothing")
    assert (unset.code, unset.err) == (1, "Parameter not set\n")
    stranger = arena.ros2("param", "get", "/nobody", "speed", *BRIEF)
    assert (stranger.code, stranger.err) == (1, "Node not found\n")


def test_param_set_changes_a_value_unless_the_node_refuses(arena: Arena) -> None:
    assert arena.ask("param", "set", "/lab/helper", "filter.window", "7").out == "Set parameter successful\n"
    assert arena.ask("param", "get", "--hide-type", "/lab/helper", "filter.window").out == "7\n"
    refused = arena.ask("param", "set", "/lab/helper", "filter.window", "8")
    assert refused.err == "Setting parameter failed: the window must be odd\n"
    assert arena.ask("param", "get", "--hide-type", "/lab/helper", "filter.window").out == "7\n"


def test_param_describe_shows_type_description_and_range(arena: Arena) -> None:
    assert arena.ask("param", "describe", "/lab/helper", "speed", "frozen").lines == [
        "Parameter name: speed",
        "  Type: double",
        "  Description: How fast, in m/s",
        "  Constraints:",
        "    Min value: 0.0",
        "    Max value: 2.0",
        "    Step: 0.5",
        "Parameter name: frozen",
        "  Type: string",
        "  Constraints:",
        "    Read only: true",
    ]


def test_param_dump_can_be_loaded_again(arena: Arena, tmp_path: Path) -> None:
    dumped = yaml.safe_load(arena.ask("param", "dump", "/lab/helper").out)
    values = dumped["/lab/helper"]["ros__parameters"]
    assert values["ids"] == [1, 2, 3]
    assert set(values["filter"]) == {"window"}
    file = tmp_path / "params.yaml"
    file.write_text(json.dumps({"/lab/helper": {"ros__parameters": {"speed": 0.5, "filter": {"window": 2}}}}))
    loaded = arena.ask("param", "load", "/lab/helper", str(file))
    assert loaded.out == "Set parameter speed successful\n"
    assert loaded.err == "Set parameter filter.window failed: the window must be odd\n"
    assert arena.ask("param", "get", "--hide-type", "/lab/helper", "speed").out == "0.5\n"


def test_param_delete_removes_only_what_is_dynamic(arena: Arena) -> None:
    assert arena.ask("param", "delete", "/lab/helper", "anything").out == "Deleted parameter successfully\n"
    refused = arena.ask("param", "delete", "/lab/helper", "ids")
    assert refused.err.startswith("Deleting parameter failed: ")


def test_interface_verbs_see_built_and_installed_interfaces(arena: Arena) -> None:
    listed, package, packages, shown, proto, unknown = arena.together(
        ("interface", "list", "-a"),
        ("interface", "package", "std_srvs"),
        ("interface", "packages", "-s"),
        ("interface", "show", "arena_interfaces/action/Count"),
        ("interface", "proto", "std_srvs/srv/SetBool"),
        ("interface", "show", "std_msgs/msg/Nothing"),
    )
    assert "    arena_interfaces/action/Count" in listed.lines
    assert package.lines == [
        "std_srvs/srv/Empty", "std_srvs/srv/SetBool", "std_srvs/srv/Trigger"
    ]  # fmt: skip
    assert "std_srvs" in packages.lines
    assert shown.out == COUNT_ACTION
    piped = arena.ros2("interface", "show", "--no-comments", "-", stdin="geometry_msgs/msg/TwistStamped\n")
    assert piped.lines[:4] == [
        "std_msgs/Header header",
        "\tbuiltin_interfaces/Time stamp",
        "\t\tint32 sec",
        "\t\tuint32 nanosec",
    ]
    assert proto.out == '"data: false\n"\n'
    assert (unknown.code, unknown.err) == (1, "Could not find the interface 'std_msgs/msg/Nothing'\n")


def test_doctor_passes_here_and_reports(lists: dict[str, Answer]) -> None:
    healthy, strict, report = lists["doctor"], lists["wtf --include-warnings"], lists["doctor --report"]
    assert healthy.code == 0
    assert healthy.out.endswith("\nAll 6 checks passed\n\n")
    assert ": UserWarning: Publisher without subscriber detected on /chatter.\n" in healthy.err
    assert strict.code == 1
    assert "Failed modules:" in strict.out
    assert "   RMW MIDDLEWARE\nmiddleware name : rmw_fastrtps_cpp\n" in report.out
