"""The names and readers of `launch_ros`'s actions and substitutions in XML and YAML launch files."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NoReturn

from launch import Action, Substitution
from launch._frontend_actions import (
    attribute_pairs,
    command_line,
    process_keywords,
    substitution_attributes,
    typed_attributes,
)
from launch._frontend_substitutions import name_substitution
from launch._readers import reader_of
from launch.frontend import Entity, Parser, expose_action
from launch.frontend.type_utils import get_data_type_from_identifier
from standin_notice import not_covered

from .actions import (
    Node,
    PushRosNamespace,
    SetParameter,
    SetParametersFromFile,
    SetRemap,
    SetROSLogDir,
    SetUseSimTime,
)
from .parameter_descriptions import ParameterFile, ParameterValue
from .substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare, Parameter

Keywords = dict[str, Any]
Nested = dict[tuple[Substitution, ...], Any]

ACTIONS_BY_NAME: dict[str, type[Action]] = {
    "node": Node,
    "push-ros-namespace": PushRosNamespace,
    "push_ros_namespace": PushRosNamespace,
    "set_parameter": SetParameter,
    "set_parameters_from_file": SetParametersFromFile,
    "set_remap": SetRemap,
    "set_ros_log_dir": SetROSLogDir,
    "set_use_sim_time": SetUseSimTime,
}


@reader_of(Node)
def _node(entity: Entity, parser: Parser) -> Keywords:
    keywords = process_keywords(entity, parser) | substitution_attributes(
        entity, parser, package="pkg", executable="exec*", name="name", exec_name="exec_name", namespace="namespace"
    )
    for keyword, name in (("arguments", "args"), ("ros_arguments", "ros_args")):
        text = entity.get_attr(name, optional=True)
        if text is not None:
            keywords[keyword] = command_line(text, parser)
    remappings = attribute_pairs(entity, parser, "remap", "from", "to")
    if remappings is not None:
        keywords["remappings"] = remappings
    parameters = entity.get_attr("param", data_type=list[Entity], optional=True)
    if parameters is not None:
        keywords["parameters"] = [_parameters(element, parser) for element in parameters]
    return keywords


def _parameters(entity: Entity, parser: Parser) -> ParameterFile | Nested:
    """Return a parameter file, or a parameter with its value or with nested parameters."""
    file = substitution_attributes(entity, parser, param_file="from")
    is_named = entity.get_attr("name", optional=True) is not None
    if file and is_named:
        raise RuntimeError("name and from attributes are mutually exclusive")
    if not file and not is_named:
        raise ValueError("param Entity should have name or from attribute")
    options = typed_attributes(entity, bool, "allow_substs")
    if is_named:
        if options:
            raise RuntimeError("'allow_substs' can only be used together with 'from' attribute")
        return _named_parameter(entity, parser)
    entity.assert_entity_completely_parsed()
    return ParameterFile(**file, **{name: parser.parse_if_substitutions(value) for name, value in options.items()})


def _named_parameter(entity: Entity, parser: Parser) -> Nested:
    name = tuple(parser.parse_substitution(entity.get_attr("name")))
    identifier = entity.get_attr("type", optional=True)
    data_type = None if identifier is None else get_data_type_from_identifier(identifier)
    value = entity.get_attr("value", data_type=data_type, optional=True)
    nested = entity.get_attr("param", data_type=list[Entity], optional=True)
    entity.assert_entity_completely_parsed()
    if nested and value is not None:
        raise RuntimeError("nested parameters and value attributes are mutually exclusive")
    if nested and data_type is not None:
        raise RuntimeError("nested parameters and type attributes are mutually exclusive")
    if nested:
        return {
            name: {
                nested_name: nested_value
                for element in nested
                for nested_name, nested_value in _named_parameter(element, parser).items()
            }
        }
    if value is None:
        raise RuntimeError("either a value attribute or nested params are needed")
    return {name: ParameterValue(parser.parse_if_substitutions(value), value_type=data_type)}


@reader_of(PushRosNamespace)
def _push_ros_namespace(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, namespace="namespace*")


@reader_of(SetParameter)
def _set_parameter(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, name="name*", value="value*")


@reader_of(SetUseSimTime)
def _set_use_sim_time(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, value="value*")


@reader_of(SetParametersFromFile)
def _set_parameters_from_file(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, filename="filename*")


@reader_of(SetRemap)
def _set_remap(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, src="from*", dst="to*")


@reader_of(SetROSLogDir)
def _set_ros_log_dir(entity: Entity, parser: Parser) -> Keywords:
    return substitution_attributes(entity, parser, new_log_dir="new_log_dir*")


def _not_covered_parser(tag: str, reason: str) -> Callable[[Entity, Parser], NoReturn]:
    def parse(entity: Entity, parser: Parser) -> NoReturn:
        raise not_covered(tag, standin="launch_ros", reason=reason)

    return parse


for _tag, _action in ACTIONS_BY_NAME.items():
    expose_action(_tag)(_action)
for _tag in ("node_container", "load_composable_node"):
    expose_action(_tag)(_not_covered_parser(_tag, "Composable nodes need C++ components"))
expose_action("ros_timer")(_not_covered_parser("ros_timer", ""))

name_substitution("exec-in-pkg", ExecutableInPackage, "executable", "package")
name_substitution("find-pkg-prefix", FindPackagePrefix, "package")
name_substitution("find-pkg-share", FindPackageShare, "package")
name_substitution("param", Parameter, "name", "default?")
