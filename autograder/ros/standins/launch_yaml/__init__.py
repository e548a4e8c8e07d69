"""Stand-in for `launch_yaml`, which cannot be installed by pip: YAML launch files; see the stand-in for `launch`."""

from __future__ import annotations

from standin_notice import guard
from standin_submodules import offer_submodules

from . import launch_description_sources
from .entity import Entity
from .parser import Parser

__all__ = ["Entity", "Parser", "launch_description_sources"]

__getattr__ = guard(__name__)

offer_submodules()
