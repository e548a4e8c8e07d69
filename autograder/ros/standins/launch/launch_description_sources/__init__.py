"""Launch descriptions from launch files in Python, XML and YAML."""

from __future__ import annotations

import types
from collections.abc import Callable
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

from standin_notice import make_getattr

from ..exceptions import InvalidLaunchFileError, InvalidPythonLaunchFileError
from ..frontend import InvalidFrontendLaunchFileError, Parser
from ..launch_description import LaunchDescription
from ..launch_description_source import LaunchDescriptionSource
from ..substitution import SomeSubstitutionsType

__all__ = [
    "AnyLaunchDescriptionSource",
    "FrontendLaunchDescriptionSource",
    "InvalidFrontendLaunchFileError",
    "InvalidLaunchFileError",
    "InvalidPythonLaunchFileError",
    "PythonLaunchDescriptionSource",
    "get_launch_description_from_any_launch_file",
    "get_launch_description_from_frontend_launch_file",
    "get_launch_description_from_python_launch_file",
    "load_python_launch_file_as_module",
]


class _UncachedLoader(SourceFileLoader):
    """The loader of the real launch, except that it reads a file each time and writes no compiled file."""

    def get_code(self, fullname: str) -> types.CodeType:
        code: types.CodeType = self.source_to_code(self.get_data(self.path), self.path)
        return code


def load_python_launch_file_as_module(python_launch_file_path: str) -> types.ModuleType:
    """Return the launch file as a module. As in the real launch, it is not added to `sys.modules`."""
    loader = _UncachedLoader("python_launch_file", str(python_launch_file_path))
    spec = spec_from_loader(loader.name, loader)
    if spec is None:
        raise RuntimeError("Failed to load module spec!")
    module = module_from_spec(spec)
    loader.exec_module(module)
    return module


def get_launch_description_from_python_launch_file(python_launch_file_path: str) -> LaunchDescription:
    """Return the launch description that `generate_launch_description` of the launch file returns.

    Raises InvalidPythonLaunchFileError without such a function, or if it returns another type.
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


def get_launch_description_from_frontend_launch_file(
    frontend_launch_file_path: str, *, parser: type[Parser] = Parser
) -> LaunchDescription:
    """Return the launch description of a launch file in XML or YAML; errors of the parser are not caught."""
    root, root_parser = parser.load(frontend_launch_file_path)
    return root_parser.parse_description(root)


def get_launch_description_from_any_launch_file(launch_file_path: str) -> LaunchDescription:
    """Return the launch description of a launch file: in Python if it ends in ``.py``, otherwise in XML or YAML.

    If that fails, the other formats are tried, too. Raises InvalidLaunchFileError with the errors of all formats.
    """
    extension = Path(launch_file_path).suffix.removeprefix(".")
    loaders: list[Callable[[str], LaunchDescription]]
    loaders = [get_launch_description_from_frontend_launch_file, get_launch_description_from_python_launch_file]
    if extension == "py":
        loaders.reverse()
    elif not Parser.is_filename_valid(Path(launch_file_path).name):
        extension = ""
    errors: list[Exception] = []
    for load in loaders:
        try:
            return load(launch_file_path)
        except Exception as error:
            errors.append(error)
    raise InvalidLaunchFileError(extension, likely_errors=errors)


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description of a Python launch file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(
            location=launch_file_path,
            method="interpreted python launch file",
            load=get_launch_description_from_python_launch_file,
        )


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description of a launch file in XML or YAML."""

    def __init__(
        self,
        launch_file_path: SomeSubstitutionsType,
        *,
        method: str = "interpreted frontend launch file",
        parser: type[Parser] = Parser,
    ) -> None:
        super().__init__(
            location=launch_file_path,
            method=method,
            load=lambda path: get_launch_description_from_frontend_launch_file(path, parser=parser),
        )


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """The launch description of a launch file in any format."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(
            location=launch_file_path,
            method="interpreted launch file",
            load=get_launch_description_from_any_launch_file,
        )


__getattr__ = make_getattr(__name__)
