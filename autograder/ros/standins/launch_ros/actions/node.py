"""The action that starts a node."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Any

import yaml
from launch import LaunchContext, SomeSubstitutionsType
from launch.actions import ExecuteProcess
from launch.logging import get_logger
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from standin_notice import make_getattr

from .._temporary import temporary_parameter_file
from ..substitutions import ExecutableInPackage
from ..utilities import evaluate_parameters, make_namespace_absolute, prefix_namespace

_NO_NAME = "<node_name_unspecified>"
_NO_NAMESPACE = "<node_namespace_unspecified>"
RemapRule = tuple[SomeSubstitutionsType, SomeSubstitutionsType]


class Node(ExecuteProcess):
    """Runs an executable of a package as a ROS node.

    `name` and `namespace` replace those in the node's code; a relative namespace is appended to the one that
    `PushRosNamespace` has set. `parameters` is a list of parameter files and dictionaries, in which later
    ones override earlier ones. A dictionary is written to a temporary parameter file by YAML's rules, by which the
    text ``1e3`` becomes a number, as in Jazzy. `remappings` is a list of pairs (from, to).
    `arguments` are placed before ``--ros-args``, `ros_arguments` after it. All other arguments are those of
    `launch.actions.ExecuteProcess`.
    """

    UNSPECIFIED_NODE_NAME = _NO_NAME
    UNSPECIFIED_NODE_NAMESPACE = _NO_NAMESPACE

    def __init__(
        self,
        *,
        executable: SomeSubstitutionsType,
        package: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        namespace: SomeSubstitutionsType | None = None,
        exec_name: SomeSubstitutionsType | None = None,
        parameters: Iterable[Any] | None = None,
        remappings: Iterable[RemapRule] | None = None,
        ros_arguments: Iterable[SomeSubstitutionsType] | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
        **kwargs: Any,
    ) -> None:
        command = executable if package is None else ExecutableInPackage(package=package, executable=executable)
        for argument_name, value in (("arguments", arguments), ("ros_arguments", ros_arguments)):
            if isinstance(value, str):
                raise TypeError(f"Node: {argument_name} must be a list of strings, got the string {value!r}")
        extra_arguments = () if ros_arguments is None else ("--ros-args", *ros_arguments)
        super().__init__(cmd=[command, *(arguments or ()), *extra_arguments, "--ros-args"], name=exec_name, **kwargs)
        self._package = package
        self._executable = executable
        self._name = name
        self._namespace = namespace
        self._parameters = parameters
        self._remappings = [self._pair(rule) for rule in remappings or ()]
        self.expanded_node_name = _NO_NAME
        self.expanded_node_namespace = _NO_NAMESPACE
        self.expanded_remapping_rules: list[tuple[str, str]] | None = None

    @staticmethod
    def _pair(rule: Any) -> RemapRule:
        if isinstance(rule, str) or not isinstance(rule, (tuple, list)) or len(rule) != 2:
            raise TypeError(f"Node: remappings must be pairs such as ('scan', 'front/scan'), got {rule!r}")
        return rule[0], rule[1]

    @property
    def node_package(self) -> SomeSubstitutionsType | None:
        """The package."""
        return self._package

    @property
    def node_executable(self) -> SomeSubstitutionsType:
        """The executable."""
        return self._executable

    @property
    def node_name(self) -> str:
        """The full name of the node; parts of it are placeholders until the action is executed."""
        return prefix_namespace(self.expanded_node_namespace, self.expanded_node_name) or ""

    def is_node_name_fully_specified(self) -> bool:
        """Return whether both name and namespace are known."""
        return _NO_NAME not in self.node_name and _NO_NAMESPACE not in self.node_name

    def execute(self, context: LaunchContext) -> Any:
        """Add name, parameters and remappings to the command, and run it."""
        arguments = [
            *self._name_arguments(context),
            *self._parameter_arguments(context),
            *self._remap_arguments(context),
        ]
        self.cmd.extend(normalize_to_list_of_substitutions(argument) for argument in arguments)
        self.before_start(context)
        self._warn_about_duplicate_name(context)
        return super().execute(context)

    def before_start(self, context: LaunchContext) -> None:
        """Do nothing; subclasses override this to act once the name is known and before the process starts."""

    def _name_arguments(self, context: LaunchContext) -> list[str]:
        from rclpy.validate_namespace import validate_namespace
        from rclpy.validate_node_name import validate_node_name

        arguments = []
        try:
            if self._name is not None:
                self.expanded_node_name = _perform(context, self._name)
                validate_node_name(self.expanded_node_name)
                arguments += ["-r", f"__node:={self.expanded_node_name}"]
            own_namespace = None if self._namespace is None else _perform(context, self._namespace)
            pushed_namespace = context.launch_configurations.get("ros_namespace")
            namespace = make_namespace_absolute(prefix_namespace(pushed_namespace, own_namespace))
            if namespace is not None:
                self.expanded_node_namespace = namespace
                validate_namespace(namespace)
                arguments += ["-r", f"__ns:={namespace}"]
        except Exception:
            get_logger("launch_ros.actions.node").error(
                "Error while expanding or validating node name or namespace for 'package=%s, executable=%s, "
                "name=%s, namespace=%s':",
                self._package,
                self._executable,
                self._name,
                self._namespace,
            )
            raise
        return arguments

    def _parameter_arguments(self, context: LaunchContext) -> list[str]:
        """Return the arguments for the parameters: those for all nodes first, so that the node's own override them."""
        arguments: list[str] = []
        for item in context.launch_configurations.get("global_params", ()):
            arguments += ["--params-file", str(item)] if isinstance(item, Path) else ["-p", f"{item[0]}:={item[1]}"]
        for item in evaluate_parameters(context, self._parameters or ()):
            if isinstance(item, tuple):
                rule = _parameter_rule(*item)
                is_named = self.expanded_node_name != _NO_NAME
                arguments += ["-p", f"{self.expanded_node_name}:{rule}" if is_named else rule]
            elif isinstance(item, dict):
                arguments += ["--params-file", str(self._parameter_file(item))]
            elif item.is_file():
                arguments += ["--params-file", str(item)]
            else:
                get_logger("launch_ros.actions.node").warning("Parameter file path is not a file: %s", item)
        return arguments

    def _parameter_file(self, parameters: dict[str, Any]) -> Path:
        key = self.node_name if self.is_node_name_fully_specified() else "/**"
        return temporary_parameter_file(yaml.dump({key: {"ros__parameters": parameters}}, default_flow_style=False))

    def _remap_arguments(self, context: LaunchContext) -> list[str]:
        rules = list(context.launch_configurations.get("ros_remaps", ()))
        rules += [(_perform(context, old_name), _perform(context, new_name)) for old_name, new_name in self._remappings]
        self.expanded_remapping_rules = rules or None
        return [argument for old_name, new_name in rules for argument in ("-r", f"{old_name}:={new_name}")]

    def _warn_about_duplicate_name(self, context: LaunchContext) -> None:
        if not self.is_node_name_fully_specified():
            return
        names: dict[str, int] = context.get_locals_as_dict().get("unique_ros_node_names", {})
        names[self.node_name] = names.get(self.node_name, 0) + 1
        context.extend_globals({"unique_ros_node_names": names})
        if names[self.node_name] > 1:
            get_logger(self.node_name).warning(
                "there are now at least %d nodes with the name %s created within this launch context",
                names[self.node_name],
                self.node_name,
            )


def _perform(context: LaunchContext, value: SomeSubstitutionsType) -> str:
    return perform_substitutions(context, normalize_to_list_of_substitutions(value))


def _parameter_rule(name: str, value: Any) -> str:
    """Format a parameter as an argument to ``-p``: ``NAME:=VALUE``."""
    return f"{name}:={yaml.dump(value)}"


__getattr__ = make_getattr(__name__)
