"""Launch descriptions from YAML launch files."""

from __future__ import annotations

from launch import SomeSubstitutionsType
from launch.launch_description_sources import FrontendLaunchDescriptionSource
from standin_notice import make_getattr

from .parser import Parser

__all__ = ["YAMLLaunchDescriptionSource"]


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """The launch description of a YAML launch file."""

    def __init__(self, launch_file_path: SomeSubstitutionsType) -> None:
        super().__init__(launch_file_path, method="interpreted YAML launch file", parser=Parser)


__getattr__ = make_getattr(__name__)
