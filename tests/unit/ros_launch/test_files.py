"""Launch files: loading, including and describing them, and the errors of those that cannot be loaded."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from textwrap import dedent
from typing import Any

import launch
import pytest
from launch import LaunchContext, LaunchDescription, LaunchIntrospector
from launch.actions import (
    DeclareLaunchArgument,
    EmitEvent,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    RegisterEventHandler,
    Shutdown,
)
from launch.event_handlers import OnProcessExit
from launch.events import Shutdown as ShutdownEvent
from launch.launch_description_sources import (
    AnyLaunchDescriptionSource,
    InvalidPythonLaunchFileError,
    PythonLaunchDescriptionSource,
    load_python_launch_file_as_module,
)
from launch.substitutions import LaunchConfiguration, ThisLaunchFile, ThisLaunchFileDir

Run = Callable[..., int]
Record = Callable[[Any], Any]

INNER = """
from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument, LogInfo
from launch.substitutions import LaunchConfiguration, ThisLaunchFileDir

def generate_launch_description():
    return LaunchDescription([
        DeclareLaunchArgument("robot"),
        DeclareLaunchArgument("colour", default_value="red"),
        LogInfo(msg=[LaunchConfiguration("colour"), " ", LaunchConfiguration("robot"), " in ", ThisLaunchFileDir()]),
    ])
"""


@pytest.fixture
def inner(tmp_path: Path) -> Path:
    path = tmp_path / "inner" / "inner.launch.py"
    path.parent.mkdir()
    path.write_text(INNER)
    return path


def test_an_included_file_gets_its_arguments_and_its_own_path(
    run: Run, inner: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    source = PythonLaunchDescriptionSource([str(inner.parent), "/inner.launch.py"])
    code = run(IncludeLaunchDescription(source, launch_arguments={"robot": "r2"}.items()))
    assert code == 0
    assert f"[INFO] [launch.user]: red r2 in {inner.parent}" in capsys.readouterr().out


def test_arguments_of_an_include_stay_unless_a_group_encloses_it(
    run: Run, inner: Path, record: Record, recorded: list[str]
) -> None:
    def include() -> IncludeLaunchDescription:
        return IncludeLaunchDescription(str(inner), launch_arguments=[("robot", "r2")])

    robot = LaunchConfiguration("robot", default="unset")
    run(GroupAction([include()]), record(robot), include(), record(robot))
    assert recorded == ["unset", "r2"]


def test_after_an_include_the_outer_file_is_the_current_one_again(
    run: Run, inner: Path, tmp_path: Path, record: Record, recorded: list[str]
) -> None:
    outer = tmp_path / "outer.launch.py"
    outer.write_text(
        "from launch import LaunchDescription\ndef generate_launch_description(): return LaunchDescription()"
    )
    description = LaunchDescription(
        [
            record(ThisLaunchFile()),
            IncludeLaunchDescription(str(inner), launch_arguments=[("robot", "r2")]),
            record(ThisLaunchFileDir()),
        ]
    )
    source = launch.LaunchDescriptionSource(description, location=str(outer))
    run(IncludeLaunchDescription(source))
    assert recorded == [str(outer), str(tmp_path)]


def test_a_required_argument_that_an_include_does_not_give_is_an_error(
    run: Run, inner: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = run(IncludeLaunchDescription(str(inner), launch_arguments=[("colour", "blue")]))
    assert code == 1
    assert (
        "[ERROR] [launch]: Caught exception in launch (see debug for traceback): Included launch description "
        "missing required argument 'robot' (description: 'no description given'), given: [colour]"
    ) in capsys.readouterr().out


READS_ANNOTATIONS = {
    "a dataclass": """
        from dataclasses import dataclass, field

        @dataclass(order=True)
        class Robot:
            name: str
            speed: float = field(default=0.3)

        seen = f"{Robot('r2')}"
        """,
    "a named tuple": """
        from typing import NamedTuple

        class Robot(NamedTuple):
            name: str
            speed: float = 0.3

        seen = f"{Robot('r2')}"
        """,
    "a generic function": """
        from functools import singledispatch

        @singledispatch
        def describe(thing): return "other"

        @describe.register
        def _(thing: float): return f"Robot(name='r2', speed={thing})"

        seen = describe(0.3)
        """,
    "type hints": """
        import inspect
        import typing

        def start(name: str, speed: float): ...

        hints = typing.get_type_hints(start)
        assert start.__annotations__ == hints == {"name": str, "speed": float}
        assert "speed: float" in inspect.getsource(start)
        seen = f"Robot(name={hints['name']('r2')!r}, speed={hints['speed']('0.3')})"
        """,
}


@pytest.mark.parametrize("text", READS_ANNOTATIONS.values(), ids=READS_ANNOTATIONS)
def test_a_file_can_read_its_annotations_while_it_is_loaded(tmp_path: Path, text: str) -> None:
    path = tmp_path / "annotated.launch.py"
    path.write_text(dedent(text))
    assert load_python_launch_file_as_module(str(path)).seen == "Robot(name='r2', speed=0.3)"
    assert list(tmp_path.iterdir()) == [path]


def test_annotations_are_strings_only_in_a_file_that_asks_for_it(tmp_path: Path) -> None:
    path = tmp_path / "annotated.launch.py"
    for ask, expected in (("", int), ("from __future__ import annotations\n", "int")):
        path.write_text(f"{ask}def start(robots: int): ...\n")
        assert load_python_launch_file_as_module(str(path)).start.__annotations__ == {"robots": expected}


@pytest.mark.parametrize("arguments", [{"robot": "r2"}, ["robot:=r2"], [("a", "b", "c")]])
def test_launch_arguments_must_be_pairs(arguments: Any) -> None:
    with pytest.raises(
        ValueError, match=r"launch_arguments must be pairs of name and value, got .*items\(\) of a dict"
    ):
        IncludeLaunchDescription("x.launch.py", launch_arguments=arguments)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("def generate(): pass", r"does not contain the required function 'generate_launch_description\(\)'"),
        ("def generate_launch_description(): pass", r"generate_launch_description\(\) returned NoneType, expected"),
        ("def generate_launch_description(): return []", r"generate_launch_description\(\) returned list, expected"),
    ],
)
def test_a_file_without_a_launch_description_is_refused(tmp_path: Path, text: str, message: str) -> None:
    path = tmp_path / "bad.launch.py"
    path.write_text(text)
    with pytest.raises(InvalidPythonLaunchFileError, match=f"launch file at '{path}'.*{message}"):
        PythonLaunchDescriptionSource(str(path)).get_launch_description(LaunchContext())


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("def generate_launch_description(:", "exceptions when trying to load file of format [py]:\n - SyntaxError: "),
        ("import no_such_module", "of format [py]:\n - ModuleNotFoundError: No module named 'no_such_module'"),
        ("x = {}['key']", "of format [py]:\n - KeyError: 'key'"),
    ],
)
def test_an_error_in_a_file_is_shown_with_its_kind(
    run: Run, tmp_path: Path, capsys: pytest.CaptureFixture[str], text: str, message: str
) -> None:
    path = tmp_path / "bad.launch.py"
    path.write_text(text)
    assert run(IncludeLaunchDescription(AnyLaunchDescriptionSource(str(path)))) == 1
    assert message in capsys.readouterr().out


def test_a_missing_file_is_named(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(IncludeLaunchDescription(PythonLaunchDescriptionSource("/no/such.launch.py"))) == 1
    assert "No such file or directory: '/no/such.launch.py'" in capsys.readouterr().out


def test_a_location_with_substitutions_is_described_until_it_is_known(inner: Path) -> None:
    source = PythonLaunchDescriptionSource([LaunchConfiguration("folder"), "/inner.launch.py"])
    assert source.location == "LaunchConfig('folder') + '/inner.launch.py'"
    assert source.try_get_launch_description_without_context() is None
    context = LaunchContext()
    context.launch_configurations["folder"] = str(inner.parent)
    assert len(source.get_launch_description(context).entities) == 3
    assert source.location == str(inner)


def test_the_arguments_of_an_included_file_are_arguments_of_the_including_one(inner: Path) -> None:
    description = LaunchDescription([DeclareLaunchArgument("own"), IncludeLaunchDescription(str(inner))])
    assert [argument.name for argument in description.get_launch_arguments()] == ["own", "robot", "colour"]


def test_loading_a_launch_file_leaves_no_compiled_file(inner: Path) -> None:
    PythonLaunchDescriptionSource(str(inner)).get_launch_description(LaunchContext())
    assert [path.name for path in inner.parent.iterdir()] == ["inner.launch.py"]


def test_a_deprecated_description_causes_a_warning(run: Run, capsys: pytest.CaptureFixture[str]) -> None:
    run(LaunchDescription([LogInfo(msg="still runs")], deprecated_reason="use the other one"))
    out = capsys.readouterr().out
    assert "[WARNING] [launch]: deprecated launch description: use the other one" in out
    assert "still runs" in out


def test_a_description_is_printed_as_a_tree() -> None:
    process = ExecuteProcess(
        cmd=["echo", ["hello ", LaunchConfiguration("who")]], cwd="/tmp", env={"A": "b"}, shell=True
    )
    handler = OnProcessExit(target_action=process, on_exit=[LogInfo(msg="gone"), Shutdown()])
    description = LaunchDescription(
        [process, RegisterEventHandler(handler), EmitEvent(event=ShutdownEvent()), GroupAction([])]
    )
    first, *tree = LaunchIntrospector().format_launch_description(description).splitlines()
    assert "LaunchDescription object" in first
    assert tree[0] == (
        "├── ExecuteProcess(cmd=['echo', 'hello ' + LaunchConfig('who')], cwd=''/tmp'', env={'A': 'b'}, shell=True)"
    )
    assert tree[1].startswith("├── RegisterEventHandler('<launch.event_handlers.OnProcessExit object")
    assert tree[2] == (
        "│   └── OnProcessExit(matcher='event == ProcessExited and ExecuteLocal(event.action)', "
        "handler='<actions>', handle_once=False)"
    )
    assert tree[3:6] == [
        "│       ├── LogInfo('gone')",
        "│       └── EmitEvent(event='launch.events.Shutdown')",
        "├── EmitEvent(event='launch.events.Shutdown')",
    ]
    assert tree[6].startswith("└── Action('<launch.actions.configurations.GroupAction object")
