"""Stand-in for `launch`, which cannot be installed by pip: the part of it that this course's launch files use.

It is imported only if the real package is not installed. Names, signatures, semantics and errors are those of
`launch` in ROS 2 Jazzy (https://docs.ros.org/en/jazzy/p/launch/); the code was written for the course. It covers
launch files in Python, XML and YAML: descriptions, arguments, substitutions, conditions, groups, includes,
processes, events and timers. Any other name raises an error. For the real package run
`make real-launch`, or source an installation of ROS 2 Jazzy.
"""

from __future__ import annotations

from standin_notice import make_getattr
from standin_submodules import install_submodule_finder

from . import (
    _frontend_actions,
    _frontend_substitutions,
    actions,
    conditions,
    descriptions,
    event_handlers,
    events,
    frontend,
    launch_description_sources,
    logging,
    substitutions,
    utilities,
)
from .action import Action
from .condition import Condition
from .event import Event
from .event_handler import EventHandler
from .exceptions import InvalidLaunchFileError
from .launch_context import LaunchContext
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity, SomeEntitiesType
from .launch_description_source import LaunchDescriptionSource
from .launch_introspector import LaunchIntrospector
from .launch_service import LaunchService
from .substitution import SomeSubstitutionsType, SomeSubstitutionsType_types_tuple, Substitution

SomeActionsType = SomeEntitiesType

__all__ = [
    "Action",
    "Condition",
    "Event",
    "EventHandler",
    "InvalidLaunchFileError",
    "LaunchContext",
    "LaunchDescription",
    "LaunchDescriptionEntity",
    "LaunchDescriptionSource",
    "LaunchIntrospector",
    "LaunchService",
    "SomeActionsType",
    "SomeEntitiesType",
    "SomeSubstitutionsType",
    "SomeSubstitutionsType_types_tuple",
    "Substitution",
    "_frontend_actions",
    "_frontend_substitutions",
    "actions",
    "conditions",
    "descriptions",
    "event_handlers",
    "events",
    "frontend",
    "launch_description_sources",
    "logging",
    "substitutions",
    "utilities",
]

__getattr__ = make_getattr(__name__)

install_submodule_finder()
