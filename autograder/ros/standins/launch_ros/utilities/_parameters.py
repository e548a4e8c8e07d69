"""The evaluation of a node's `parameters`: dictionaries with substitutions become names and values.

Plain values keep their type, and plain text stays text. The text of a substitution is read by YAML's rules, so
``LaunchConfiguration('speed')`` can be a number. Nested dictionaries become dotted names.
"""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

import yaml
from launch import LaunchContext, Substitution
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import is_substitution, is_uniform_list

from ..parameter_descriptions import Parameter, ParameterFile, ParameterValue

EvaluatedParameters = Path | dict[str, Any] | tuple[str, Any]
_ALLOWED = "bool, int, float, str, or a list of one of them"


def evaluate_parameters(context: LaunchContext, parameters: Iterable[Any]) -> list[EvaluatedParameters]:
    """Return the evaluated `parameters`: a path for a file, a flat dictionary, or a pair for a `Parameter`.

    Raises TypeError for any other item, and for values of a type that parameters do not have.
    """
    if isinstance(parameters, (str, os.PathLike, Mapping, Substitution)):
        raise TypeError(f"Expecting list of parameters, got {parameters!r}: put it in a list, parameters=[...]")
    return [_evaluate(context, parameter) for parameter in parameters]


def _evaluate(context: LaunchContext, parameter: Any) -> EvaluatedParameters:
    if isinstance(parameter, Mapping):
        return flatten(context, parameter)
    if isinstance(parameter, (Parameter, ParameterFile)):
        return parameter.evaluate(context)
    if isinstance(parameter, os.PathLike):
        return Path(os.fspath(parameter))
    if isinstance(parameter, (str, Substitution, Sequence)):
        return Path(perform_substitutions(context, normalize_to_list_of_substitutions(parameter)))
    raise TypeError(
        f"parameters must be files, dictionaries or launch_ros.descriptions, got {type(parameter).__name__}"
    )


def flatten(context: LaunchContext, parameters: Mapping[Any, Any], prefix: str = "") -> dict[str, Any]:
    """Return `parameters` with evaluated names and values; the names of nested ones have dots."""
    flat: dict[str, Any] = {}
    for key, value in parameters.items():
        name = prefix + perform_substitutions(context, normalize_to_list_of_substitutions(key))
        if isinstance(value, Mapping):
            flat.update(flatten(context, value, f"{name}."))
        else:
            flat[name] = evaluate_value(context, name, value)
    return flat


def evaluate_value(context: LaunchContext, name: str, value: Any) -> Any:
    """Return one value; raise TypeError or ValueError if it has a type that parameters do not have."""
    if isinstance(value, ParameterValue):
        return value.evaluate(context)
    if isinstance(value, (bool, int, float, str, bytes)):
        return value
    if is_substitution(value):
        return _from_yaml(name, perform_substitutions(context, normalize_to_list_of_substitutions(value)))
    if isinstance(value, Sequence):
        return _evaluate_list(context, name, value)
    raise TypeError(f"parameter '{name}': allowed values are {_ALLOWED}, got {type(value).__name__}")


def _from_yaml(name: str, text: str) -> Any:
    hint = (
        "If the parameter is meant to be a string, try wrapping it in "
        "launch_ros.parameter_descriptions.ParameterValue(value, value_type=str)"
    )
    try:
        value = yaml.safe_load(text)
    except yaml.YAMLError as error:
        raise ValueError(f"Unable to parse the value of parameter {name} as yaml. {hint}") from error
    if isinstance(value, (bool, int, float, str)) or (value and is_uniform_list(value)):
        return value
    raise TypeError(
        f"parameter '{name}': allowed values are {_ALLOWED}, got {text!r}, which is {type(value).__name__}. {hint}"
    )


def _evaluate_list(context: LaunchContext, name: str, values: Sequence[Any]) -> list[Any]:
    """Return the list with evaluated items; integers and floats become floats, other mixed types become text."""
    items = [
        item if isinstance(item, (bool, int, float, str)) else evaluate_value(context, name, item) for item in values
    ]
    if is_uniform_list(items):
        return items
    if all(isinstance(item, (int, float)) and not isinstance(item, bool) for item in items):
        return [float(item) for item in items]
    if any(is_substitution(item) for item in values):
        raise TypeError(f"parameter '{name}': expected a list with items of uniform type, got {items}")
    return [str(item) for item in items]
