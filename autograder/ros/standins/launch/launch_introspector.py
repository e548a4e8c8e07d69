"""The text of `ros2 launch --print-description`: a launch description as a tree, without executing it."""

from __future__ import annotations

from collections.abc import Iterable

from standin_notice import make_getattr

from .actions import EmitEvent, ExecuteProcess, LogInfo, RegisterEventHandler
from .launch_description import LaunchDescription
from .launch_description_entity import LaunchDescriptionEntity
from .substitution import describe_substitutions


def _line(entity: LaunchDescriptionEntity) -> str:
    if isinstance(entity, LogInfo):
        return f"LogInfo({describe_substitutions(entity.msg)})"
    if isinstance(entity, EmitEvent):
        return f"EmitEvent(event='{entity.event.name}')"
    if isinstance(entity, ExecuteProcess):
        return entity.describe()
    if isinstance(entity, RegisterEventHandler):
        return f"RegisterEventHandler('{entity.event_handler}'):"
    return f"Action('{entity}')"


def _tree(entities: Iterable[LaunchDescriptionEntity], indent: str) -> list[str]:
    remaining = list(entities)
    lines = []
    while remaining:
        entity = remaining.pop(0)
        lines.append(f"{indent}{'├' if remaining else '└'}── {_line(entity)}")
        if isinstance(entity, RegisterEventHandler):
            inner_indent = indent + ("│   " if remaining else "    ")
            description, handler_entities = entity.event_handler.describe()
            lines.append(f"{inner_indent}└── {description}")
            lines += _tree(handler_entities, inner_indent + "    ")
    return lines


class LaunchIntrospector:
    """Describes launch descriptions."""

    def format_launch_description(self, launch_description: LaunchDescription) -> str:
        """Return the launch description as text, with one line for each entity."""
        return "\n".join([f"{launch_description}", *_tree(launch_description.entities, "")])


__getattr__ = make_getattr(__name__)
