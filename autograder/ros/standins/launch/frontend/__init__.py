"""Launch files in XML and YAML: `launch_xml` and `launch_yaml` read the files, this package creates the actions."""

from __future__ import annotations

from standin_notice import make_getattr

from ..utilities import type_utils
from .entity import Entity
from .expose import expose_action, expose_substitution
from .parse_substitution import parse_if_substitutions, parse_substitution
from .parser import InvalidFrontendLaunchFileError, Parser

__all__ = [
    "Entity",
    "InvalidFrontendLaunchFileError",
    "Parser",
    "expose_action",
    "expose_substitution",
    "parse_if_substitutions",
    "parse_substitution",
    "type_utils",
]

__getattr__ = make_getattr(__name__)
