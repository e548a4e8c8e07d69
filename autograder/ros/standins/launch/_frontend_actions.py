"""The names and attributes of `launch`'s actions in XML and YAML launch files."""

from __future__ import annotations

import shlex
from typing import Any

from ._readers import reader_of
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

ACTIONS_BY_NAME: dict[str, type[Action]] = {
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


def substitution_attributes(entity: Entity, parser: Parser, **keywords: str) -> Keywords:
    """Return the attributes whose text may contain substitutions, by keyword, without the missing ones.

    Args:
        entity: the element.
        parser: its parser.
        keywords: for each keyword the name of the attribute; a name with ``*`` at its end is required.
    """
    attributes = {}
    for keyword, name in keywords.items():
        value = entity.get_attr(name.removesuffix("*"), optional=not name.endswith("*"))
        if value is not None:
            attributes[keyword] = parser.parse_substitution(value)
    return attributes


def typed_attributes(entity: Entity, data_type: type, *names: str) -> Keywords:
    """Return the attributes of a type, by their names, without the missing ones."""
    attributes = {name: entity.get_attr(name, data_type=data_type, optional=True) for name in names}
    return {name: value for name, value in attributes.items() if value is not None}


def attribute_pairs(
    entity: Entity, parser: Parser, child: str, first: str, second: str
) -> list[tuple[Any, Any]] | None:
    """Return two attributes of each child of a type, or None without such a child."""
    children = entity.get_attr(child, data_type=list[Entity], optional=True)
    if children is None:
        return None
    result = []
    for element in children:
        attributes = substitution_attributes(element, parser, first=f"{first}*", second=f"{second}*")
        element.assert_entity_completely_parsed()
        result.append((attributes["first"], attributes["second"]))
    return result


def _read_mapping(entity: Entity, parser: Parser, child: str) -> dict[Any, Any] | None:
    items = attribute_pairs(entity, parser, child, "name", "value")
    return None if items is None else {tuple(name): value for name, value in items}


@reader_of(Action)
def _condition(entity: Entity, parser: Parser) -> Keywords:
    keywords = substitution_attributes(entity, parser, if_="if", unless="unless")
    if len(keywords) == 2:
        raise RuntimeError("if and unless conditions can't be used simultaneously")
    if "if_" in keywords:
        return {"condition": IfCondition(keywords["if_"])}
    return {"condition": UnlessCondition(keywords["unless"])} if keywords else {}


@reader_of(SetEnvironmentVariable)
@reader_of(SetLaunchConfiguration)
def _name_and_value(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, name="name*", value="value*")


@reader_of(UnsetEnvironmentVariable)
def _name(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, name="name*")


@reader_of(AppendEnvironmentVariable)
def _append_env(entity: Entity, parser: Parser) -> Keywords:
    keywords = substitution_attributes(entity, parser, name="name*", value="value*", separator="separator")
    prepend = typed_attributes(entity, bool, "prepend")
    return keywords | {name: parser.parse_if_substitutions(value) for name, value in prepend.items()}


@reader_of(DeclareLaunchArgument)
def _arg(entity: Entity, parser: Parser) -> Keywords:
    keywords: Keywords = {"name": parser.escape_characters(entity.get_attr("name"))}
    keywords |= substitution_attributes(entity, parser, default_value="default")
    description = entity.get_attr("description", optional=True)
    if description is not None:
        keywords["description"] = parser.escape_characters(description)
    choices = entity.get_attr("choice", data_type=list[Entity], optional=True)
    if choices is not None:
        keywords["choices"] = [parser.escape_characters(choice.get_attr("value")) for choice in choices]
    return keywords


@reader_of(LogInfo)
def _log(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, msg="message*")


@reader_of(Shutdown)
def _shutdown(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, reason="reason")


@reader_of(ResetLaunchConfigurations)
def _reset(entity: Entity, parser: Parser) -> Keywords:
    configurations = _read_mapping(entity, parser, "keep")
    return {} if configurations is None else {"launch_configurations": configurations}


@reader_of(GroupAction)
def _group(entity: Entity, parser: Parser) -> Keywords:
    keywords = typed_attributes(entity, bool, "scoped", "forwarding") | _reset(entity, parser)
    keywords["actions"] = [parser.parse_action(child) for child in entity.children if child.type_name != "keep"]
    return keywords


@reader_of(IncludeLaunchDescription)
def _include(entity: Entity, parser: Parser) -> Keywords:
    keywords = substitution_attributes(entity, parser, launch_description_source="file*")
    arguments = attribute_pairs(entity, parser, "arg", "name", "value")
    return keywords if arguments is None else {**keywords, "launch_arguments": arguments}


@reader_of(TimerAction)
def _timer(entity: Entity, parser: Parser) -> Keywords:
    keywords: Keywords = {"period": parser.parse_if_substitutions(entity.get_attr("period", data_type=float))}
    keywords["actions"] = [parser.parse_action(child) for child in entity.children]
    cancel = typed_attributes(entity, bool, "cancel_on_shutdown")
    return keywords | {name: parser.parse_if_substitutions(value) for name, value in cancel.items()}


@reader_of(ExecuteProcess)
def _executable(entity: Entity, parser: Parser) -> Keywords:
    return {"cmd": command_line(entity.get_attr("cmd"), parser), **process_keywords(entity, parser)}


def process_keywords(entity: Entity, parser: Parser) -> Keywords:
    """Return the keyword arguments of a process, except its command."""
    keywords = substitution_attributes(
        entity, parser, cwd="cwd", name="name", prefix="launch-prefix", output="output", respawn="respawn"
    )
    on_exit = entity.get_attr("on_exit", optional=True)
    if on_exit is not None:
        if on_exit != "shutdown":
            raise ValueError(
                f"Attribute on_exit of Entity {entity.type_name} expected to be shutdown but got `{on_exit}`"
            )
        keywords["on_exit"] = [Shutdown()]
    keywords |= typed_attributes(entity, int, "respawn_max_retries") | typed_attributes(
        entity, bool, "shell", "emulate_tty"
    )
    for name, seconds in typed_attributes(entity, float, "respawn_delay", "sigterm_timeout", "sigkill_timeout").items():
        if seconds < 0.0:
            raise ValueError(
                f"Attribute {name} of Entity {entity.type_name} expected to be a non-negative value but got `{seconds}`"
            )
        keywords[name] = seconds if name == "respawn_delay" else str(seconds)
    variables = _read_mapping(entity, parser, "env")
    return keywords if variables is None else {**keywords, "additional_env": variables}


def command_line(text: str, parser: Parser) -> list[list[Substitution]]:
    """Return the words of a command line; each is a list of plain text and substitutions.

    Spaces, quotation marks and backslashes outside of substitutions separate words as in a shell.
    """
    words: list[list[Substitution]] = [[]]
    for part in parser.parse_substitution(text):
        if not isinstance(part, TextSubstitution):
            words[-1].append(part)
            continue
        new_words: list[list[Substitution]] = [[TextSubstitution(text=word)] for word in shlex.split(part.text)]
        if not new_words or part.text[0].isspace():
            words.append([])
        if new_words:
            words[-1] += new_words[0]
            words += new_words[1:]
            if part.text[-1].isspace():
                words.append([])
    return [word for word in words if word]


for _tag, _action in ACTIONS_BY_NAME.items():
    expose_action(_tag)(_action)
