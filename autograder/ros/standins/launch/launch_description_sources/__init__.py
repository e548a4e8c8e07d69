"""Launch descriptions from Python launch files."""

from __future__ import annotations

import types
from pathlib import Path

from standin_notice import guard, not_covered

from ..exceptions import InvalidLaunchFileError, InvalidPythonLaunchFileError
from ..launch_description import LaunchDescription
from ..launch_description_source import LaunchDescriptionSource
from ..substitution import SomeSubstitutionsType

__all__ = [
    "AnyLaunchDescriptionSource",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "PythonLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]

_FRONTENDS = "XML and YAML launch files are read by launch_xml and launch_yaml, which have no stand-in"


def load_python_launch_file_as_module(python_launch_file_path: str) -> types.ModuleType:
    """Return the launch file as a module; it is read anew each time and leaves no compiled file behind."""
    path = Path(python_launch_file_path)
    module = types.ModuleType("python_launch_file")
    module.__file__ = str(path)
    exec(compile(path.read_bytes(), str(path), "exec"), module.__dict__)
    return module


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> LaunchDescription:
    """Return what `generate_launch_description` of the launch file returns.

    Raises InvalidPythonLaunchFileError if there is no such function or it returns something else.
    """
    module = load_python_launch_file_as_module(python_launch_file_path)
    generate = getattr(module, "generate_launch_description", None)
    if generate is None:
        raise InvalidPythonLaunchFileError(
            f"launch file at '{python_launch_file_path}' does not contain the required function "
            "'generate_launch_description()'"
        )
    description = generate()
    if not isinstance(description, LaunchDescription):
        raise InvalidPythonLaunchFileError(
            f"launch file at '{python_launch_file_path}': generate_launch_description() returned "
            f"{type(description).__name__}, expected a LaunchDescription"
        )
    return description


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """Return the launch description of a launch file, whose ending must be ``.py``.

    Raises InvalidLaunchFileError that names what went wrong in it, NotInStandInError for XML and YAML.
    """
    extension = Path(launch_file_path).suffix.removeprefix(".")
    if extension in ("xml", "yaml", "yml"):
        raise not_covered(f"the launch file '{launch_file_path}'", standin="launch", reason=_FRONTENDS)
    try:
        return get_launch_description_from_python_launch_file(launch_file_path)
    except Exception as error:
        raise InvalidLaunchFileError(extension, likely_errors=[error]) from error


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description of a Python launch file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(
            location=launch_file_path,
            method="interpreted python launch file",
            load=get_launch_description_from_python_launch_file,
        )


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description of a launch file of any kind, of which only Python is covered here."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(
            location=launch_file_path,
            method="interpreted launch file",
            load=get_launch_description_from_any_launch_file,
        )


__getattr__ = guard(
    __name__,
    {
        "XMLLaunchDescriptionSource": _FRONTENDS,
        "YAMLLaunchDescriptionSource": _FRONTENDS,
        "FrontendLaunchDescriptionSource": _FRONTENDS,
    },
)
