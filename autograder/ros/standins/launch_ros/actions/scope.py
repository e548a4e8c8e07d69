"""Actions on all later nodes in the same scope: namespace, remappings, parameters, log files."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from launch import Action, LaunchContext, SomeSubstitutionsType
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from rclpy.logging import get_logging_directory
from rclpy.parameter import Parameter
from rclpy.validate_namespace import validate_namespace

from ..parameter_descriptions import ParameterFile
from ..utilities import make_namespace_absolute, prefix_namespace
from ..utilities._parameters import evaluate_value


class PushRosNamespace(Action):
    """Puts the later nodes in a namespace."""

    def __init__(self, namespace: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.namespace = normalize_to_list_of_substitutions(namespace)

    def execute(self, context: LaunchContext) -> None:
        """Set the namespace, relative to the one that is already set."""
        added = perform_substitutions(context, self.namespace)
        previous = context.launch_configurations.get("ros_namespace")
        namespace = make_namespace_absolute(prefix_namespace(previous, added))
        validate_namespace(namespace)
        context.launch_configurations["ros_namespace"] = namespace


class SetRemap(Action):
    """Remaps a name for the later nodes."""

    def __init__(self, src: SomeSubstitutionsType, dst: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.src = normalize_to_list_of_substitutions(src)
        self.dst = normalize_to_list_of_substitutions(dst)

    def execute(self, context: LaunchContext) -> None:
        """Add the rule."""
        rule = (perform_substitutions(context, self.src), perform_substitutions(context, self.dst))
        _add(context, "ros_remaps", rule)


class SetParameter(Action):
    """Sets a parameter for the later nodes; their own parameters override it."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.name = normalize_to_list_of_substitutions(name)
        if isinstance(value, Mapping):
            raise TypeError("SetParameter: the value must be a scalar or a list, got a dictionary")
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        """Add the parameter, which replaces an earlier value."""
        name = perform_substitutions(context, self.name)
        others = [
            item
            for item in context.launch_configurations.get("global_params", ())
            if not (isinstance(item, tuple) and item[0] == name)
        ]
        value = evaluate_value(context, name, self.value)
        context.launch_configurations["global_params"] = (*others, (name, value))


class SetUseSimTime(Action):
    """Makes the launch itself use the time of ``/clock``; this does not affect the nodes.

    Raises ValueError on execution if the value is not a bool, as substitutions are not performed.
    """

    def __init__(self, value: bool, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.value = value

    def execute(self, context: LaunchContext) -> None:
        """Set the parameter for the whole launch."""
        parameter = Parameter("use_sim_time", Parameter.Type.BOOL, self.value)
        context.extend_globals({"use_sim_time": parameter.value})


class SetParametersFromFile(Action):
    """Gives a parameter file to the later nodes; their own parameters override it.

    Raises FileNotFoundError on execution if the file does not exist.
    """

    def __init__(self, filename: str | os.PathLike[str] | SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self._file = ParameterFile(filename)

    def execute(self, context: LaunchContext) -> None:
        """Add the file."""
        path = self._file.evaluate(context).absolute()
        if not path.is_file():
            raise FileNotFoundError(f"SetParametersFromFile: there is no parameter file '{path}'")
        _add(context, "global_params", path)


class SetROSLogDir(Action):
    """Sets the folder of the nodes' log files; a relative path is appended to the folder that is already set."""

    def __init__(self, new_log_dir: SomeSubstitutionsType, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        self.log_dir = normalize_to_list_of_substitutions(new_log_dir)

    def execute(self, context: LaunchContext) -> None:
        """Set the variable ``ROS_LOG_DIR``, which the later nodes inherit."""
        current = context.environment.get("ROS_LOG_DIR") or get_logging_directory()
        context.environment["ROS_LOG_DIR"] = str(Path(current) / perform_substitutions(context, self.log_dir))


def _add(context: LaunchContext, key: str, item: Any) -> None:
    # Creates a new tuple, because a saved scope must not contain items that were added later.
    context.launch_configurations[key] = (*context.launch_configurations.get(key, ()), item)
