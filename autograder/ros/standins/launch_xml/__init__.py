"""Stand-in for `launch_xml`, which cannot be installed by pip: XML launch files. See the stand-in for `launch`."""

from __future__ import annotations

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

from . import launch_description_sources
from .entity import Entity
from .parser import Parser

__all__ = ["Entity", "Parser", "launch_description_sources"]

__getattr__ = make_getattr(__name__)

install_submodule_finder()
