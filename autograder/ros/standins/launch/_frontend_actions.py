"""What the actions of `launch` are called in XML and YAML launch files, and which attributes they have there."""

from __future__ import annotations

import shlex
from typing import Any

from ._readers import reads
from .action import Action
from .actions import (
    AppendEnvironmentVariable,
    DeclareLaunchArgument,
    ExecuteProcess,
    GroupAction,
    IncludeLaunchDescription,
    LogInfo,
    ResetEnvironment,
    ResetLaunchConfigurations,
    SetEnvironmentVariable,
    SetLaunchConfiguration,
    Shutdown,
    TimerAction,
    UnsetEnvironmentVariable,
)
from .conditions import IfCondition, UnlessCondition
from .frontend import Entity, Parser, expose_action
from .substitution import Substitution, TextSubstitution

Keywords = dict[str, Any]

NAMES: dict[str, type[Action]] = {
    "append_env": AppendEnvironmentVariable,
    "arg": DeclareLaunchArgument,
    "executable": ExecuteProcess,
    "group": GroupAction,
    "include": IncludeLaunchDescription,
    "let": SetLaunchConfiguration,
    "log": LogInfo,
    "reset": ResetLaunchConfigurations,
    "reset_env": ResetEnvironment,
    "set_env": SetEnvironmentVariable,
    "shutdown": Shutdown,
    "timer": TimerAction,
    "unset_env": UnsetEnvironmentVariable,
}


def texts(entity: Entity, parser: Parser, **keywords: str) -> Keywords:
    """Return the attributes whose text may hold substitutions, by keyword; those that are missing are left out.

    Args:
        entity: the element.
        parser: its parser.
        keywords: for each keyword the name of the attribute; a name with ``*`` at its end must be there.
    """
    found = {}
    for keyword, name in keywords.items():
        value = entity.get_attr(name.removesuffix("*"), optional=not name.endswith("*"))
        if value is not None:
            found[keyword] = parser.parse_substitution(value)
    return found


def values(entity: Entity, data_type: type, *names: str) -> Keywords:
    """Return the attributes of a type, by their names; those that are missing are left out."""
    found = {name: entity.get_attr(name, data_type=data_type, optional=True) for name in names}
    return {name: value for name, value in found.items() if value is not None}


def pairs(entity: Entity, parser: Parser, child: str, first: str, second: str) -> list[tuple[Any, Any]] | None:
    """Return two attributes of each child of a type, or None if there is no such child."""
    children = entity.get_attr(child, data_type=list[Entity], optional=True)
    if children is None:
        return None
    found = []
    for one in children:
        read = texts(one, parser, first=f"{first}*", second=f"{second}*")
        one.assert_entity_completely_parsed()
        found.append((read["first"], read["second"]))
    return found


def _mapping(entity: Entity, parser: Parser, child: str) -> dict[Any, Any] | None:
    found = pairs(entity, parser, child, "name", "value")
    return None if found is None else {tuple(name): value for name, value in found}


@reads(Action)
def _condition(entity: Entity, parser: Parser) -> Keywords:
    found = texts(entity, parser, if_="if", unless="unless")
    if len(found) == 2:
        raise RuntimeError("if and unless conditions can't be used simultaneously")
    if "if_" in found:
        return {"condition": IfCondition(found["if_"])}
    return {"condition": UnlessCondition(found["unless"])} if found else {}


@reads(SetEnvironmentVariable)
@reads(SetLaunchConfiguration)
def _name_and_value(entity: Entity, parser: Parser) -> Keywords:
    return texts(entity, parser, name="name*", value="value*")


@reads(UnsetEnvironmentVariable)
def _name(entity: Entity, parser: Parser) -> Keywords:
    return texts(entity, parser, name="name*")


@reads(AppendEnvironmentVariable)
def _append_env(entity: Entity, parser: Parser) -> Keywords:
    found = texts(entity, parser, name="name*", value="value*", separator="separator")
    prepend = values(entity, bool, "prepend")
    return found | {name: parser.parse_if_substitutions(value) for name, value in prepend.items()}


@reads(DeclareLaunchArgument)
def _arg(entity: Entity, parser: Parser) -> Keywords:
    found: Keywords = {"name": parser.escape_characters(entity.get_attr("name"))}
    found |= texts(entity, parser, default_value="default")
    description = entity.get_attr("description", optional=True)
    if description is not None:
        found["description"] = parser.escape_characters(description)
    choices = entity.get_attr("choice", data_type=list[Entity], optional=True)
    if choices is not None:
        found["choices"] = [parser.escape_characters(choice.get_attr("value")) for choice in choices]
    return found


@reads(LogInfo)
def _log(entity: Entity, parser: Parser) -> Keywords:
    return texts(entity, parser, msg="message*")


@reads(Shutdown)
def _shutdown(entity: Entity, parser: Parser) -> Keywords:
    return texts(entity, parser, reason="reason")


@reads(ResetLaunchConfigurations)
def _reset(entity: Entity, parser: Parser) -> Keywords:
    kept = _mapping(entity, parser, "keep")
    return {} if kept is None else {"launch_configurations": kept}


@reads(GroupAction)
def _group(entity: Entity, parser: Parser) -> Keywords:
    found = values(entity, bool, "scoped", "forwarding") | _reset(entity, parser)
    found["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != "keep"]
    return found


@reads(IncludeLaunchDescription)
def _include(entity: Entity, parser: Parser) -> Keywords:
    found = texts(entity, parser, launch_description_source="file*")
    arguments = pairs(entity, parser, "arg", "name", "value")
    return found if arguments is None else {**found, "launch_arguments": arguments}


@reads(TimerAction)
def _timer(entity: Entity, parser: Parser) -> Keywords:
    found: Keywords = {"period": parser.parse_if_substitutions(entity.get_attr("period", data_type=float))}
    found["actions"] = [parser.parse_action(child) for child in entity.children]
    cancel = values(entity, bool, "cancel_on_shutdown")
    return found | {name: parser.parse_if_substitutions(value) for name, value in cancel.items()}


@reads(ExecuteProcess)
def _executable(entity: Entity, parser: Parser) -> Keywords:
    return {"cmd": command_line(entity.get_attr("cmd"), parser), **process(entity, parser)}


def process(entity: Entity, parser: Parser) -> Keywords:
    """Return what a process has beside its command."""
    found = texts(entity, parser, cwd="cwd", name="name", prefix="launch-prefix", output="output", respawn="respawn")
    on_exit = entity.get_attr("on_exit", optional=True)
    if on_exit is not None:
        if on_exit != "shutdown":
            raise ValueError(
                f"Attribute on_exit of Entity {entity.type_name} expected to be shutdown but got `{on_exit}`"
            )
        found["on_exit"] = [Shutdown()]
    found |= values(entity, int, "respawn_max_retries") | values(entity, bool, "shell", "emulate_tty")
    for name, seconds in values(entity, float, "respawn_delay", "sigterm_timeout", "sigkill_timeout").items():
        if seconds < 0.0:
            raise ValueError(
                f"Attribute {name} of Entity {entity.type_name} expected to be a non-negative value but got `{seconds}`"
            )
        found[name] = seconds if name == "respawn_delay" else str(seconds)
    variables = _mapping(entity, parser, "env")
    return found if variables is None else {**found, "additional_env": variables}


def command_line(text: str, parser: Parser) -> list[list[Substitution]]:
    """Return the words of a command line; each is a row of plain text and substitutions.

    Spaces, quotation marks and backslashes outside of substitutions separate words as in a shell.
    """
    words: list[list[Substitution]] = [[]]
    for part in parser.parse_substitution(text):
        if not isinstance(part, TextSubstitution):
            words[-1].append(part)
            continue
        plain: list[list[Substitution]] = [[TextSubstitution(text=word)] for word in shlex.split(part.text)]
        if not plain or part.text[0].isspace():
            words.append([])
        if plain:
            words[-1] += plain[0]
            words += plain[1:]
            if part.text[-1].isspace():
                words.append([])
    return [word for word in words if word]


for _tag, _action in NAMES.items():
    expose_action(_tag)(_action)
