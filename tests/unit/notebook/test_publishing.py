"""Messages that a notebook's function publishes during a drive, step by step."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path
from typing import Any

import pytest
from std_msgs.msg import Int32, String

from autograder.exceptions import UsageError
from autograder.notebook.publishing import messages_at, plan_messages, types_of


def test_messages_arrive_unchanged_at_their_steps(tmp_path: Path) -> None:
    planned_run = plan_messages(
        lambda t: {"mode": String(data=f"é {t}"), "/n": Int32(data=-7)} if t >= 0.2 else None, 0.4, tmp_path
    )
    types = types_of(planned_run)
    assert types == {"/mode": String, "/n": Int32}
    assert messages_at(planned_run, types, 100_000_000) == {}
    assert messages_at(planned_run, types, 200_000_000) == {"/mode": String(data="é 0.2"), "/n": Int32(data=-7)}
    assert messages_at(planned_run, types, 250_000_000) == {}
    assert messages_at(planned_run, types, 400_000_000) == {"/mode": String(data="é 0.4"), "/n": Int32(data=-7)}
    assert (
        messages_at(planned_run, types, 500_000_000) == messages_at(planned_run, types, 0) == {}
    )  # after and before the drive


@pytest.mark.parametrize(
    ("returned", "message"),
    [
        ("fast", r"at 0.1 s, each_step returned 'fast': return messages by topic, such as {'/mode': String\(\)}"),
        ({"/mode": "fast"}, r"each_step returned 'fast' for /mode: return a message, such as String\(data='fast'\)"),
        ({"/scan": String()}, "each_step cannot publish on /scan: the simulator and your program use it"),
        ({"a b": String()}, "each_step names the topic '/a b', which is not a valid topic name"),
    ],
)
def test_a_value_that_cannot_be_published_is_named(tmp_path: Path, returned: Any, message: str) -> None:
    with pytest.raises(UsageError, match=message):
        plan_messages(lambda t: returned, 1.0, tmp_path)


def test_a_topic_has_one_type(tmp_path: Path) -> None:
    with pytest.raises(UsageError, match=r"at 0.2 s, each_step returned a std_msgs/msg/Int32 for /n, and before a"):
        plan_messages(lambda t: {"/n": Int32() if t > 0.15 else String()}, 1.0, tmp_path)


def test_a_type_that_the_workspace_builds_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    package = tmp_path / "ws" / "install" / "own_msgs"
    package.mkdir(parents=True)
    text = "class Own:\n    get_fields_and_field_types = None\n"
    (package / "__init__.py").write_text(text)
    monkeypatch.syspath_prepend(package.parent)
    own_msgs = import_module("own_msgs")

    with pytest.raises(UsageError, match="a message of own_msgs, which your workspace builds: use an installed type"):
        plan_messages(lambda t: {"/own": own_msgs.Own()}, 1.0, tmp_path / "ws")
