"""Parameters with an explicit type, and parameter files with substitutions."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import yaml
from launch import LaunchContext, SomeSubstitutionsType, Substitution
from launch.frontend import parse_substitution
from launch.substitutions import SubstitutionFailure
from launch.utilities import normalize_to_list_of_substitutions, perform_substitutions
from launch.utilities.type_utils import normalize_typed_substitution, perform_typed_substitution
from standin_notice import make_getattr

from ._temporary import temporary_parameter_file

__all__ = ["Parameter", "ParameterFile", "ParameterValue"]


class ParameterValue:
    """A value, or substitutions whose text is converted to `value_type`.

    Without a type, the text is read by YAML's rules, by which ``1e3`` and ``yes`` are not strings. With
    ``value_type=str`` it stays a string.
    """

    def __init__(self, value: Any, *, value_type: Any = None) -> None:
        self.value = normalize_typed_substitution(value, value_type)
        self.value_type = value_type

    def evaluate(self, context: LaunchContext) -> Any:
        """Return the value in `context`; raise ValueError if it cannot be converted to the type."""
        return perform_typed_substitution(context, self.value, self.value_type)


class Parameter:
    """A parameter: a name, and a value as in `ParameterValue`."""

    def __init__(self, name: SomeSubstitutionsType, value: Any, *, value_type: Any = None) -> None:
        self.name = normalize_to_list_of_substitutions(name)
        self._value = ParameterValue(value, value_type=value_type)

    @property
    def value(self) -> Any:
        """The value, before it is evaluated."""
        return self._value.value

    def evaluate(self, context: LaunchContext) -> tuple[str, Any]:
        """Return the name and the value in `context`."""
        return perform_substitutions(context, self.name), self._value.evaluate(context)


class ParameterFile:
    """A parameter file; with `allow_substs`, substitutions in it such as ``$(var name)`` are performed."""

    def __init__(
        self,
        param_file: str | os.PathLike[str] | SomeSubstitutionsType,
        *,
        allow_substs: bool | SomeSubstitutionsType = False,
    ) -> None:
        self.param_file: list[Substitution] = normalize_to_list_of_substitutions(
            os.fspath(param_file) if isinstance(param_file, os.PathLike) else param_file
        )
        self.allow_substs = normalize_typed_substitution(allow_substs, bool)

    def evaluate(self, context: LaunchContext) -> Path:
        """Return the path of the file, or of a temporary one with the substitutions performed.

        Raises SubstitutionFailure if a substitution fails or the result is not YAML.
        """
        path = Path(perform_substitutions(context, self.param_file))
        if not perform_typed_substitution(context, self.allow_substs, bool):
            return path
        substituted = perform_substitutions(context, parse_substitution(path.read_text(encoding="utf-8")))
        try:
            yaml.safe_load(substituted)
        except yaml.YAMLError as error:
            raise SubstitutionFailure(
                f"The substituted parameter file '{path}' is not a valid yaml file: {error}"
            ) from error
        return temporary_parameter_file(substituted)


__getattr__ = make_getattr(__name__)
