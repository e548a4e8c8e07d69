"""An event handler that waits until a process prints that it is ready."""

from __future__ import annotations

from collections.abc import Iterable

from launch import LaunchDescriptionEntity, SomeEntitiesType
from launch.actions import ExecuteLocal
from launch.event_handlers import OnProcessIO
from launch.events.process import ProcessIO
from standin_notice import make_getattr

__all__ = ["StdoutReadyListener"]


class StdoutReadyListener(OnProcessIO):
    """Executes `actions` when a piece of a process's standard output contains `ready_txt`."""

    def __init__(self, *, target_action: ExecuteLocal | None = None, ready_txt: str, actions: SomeEntitiesType) -> None:
        def on_stdout(event: ProcessIO) -> SomeEntitiesType | None:
            return actions if ready_txt in event.text.decode() else None

        super().__init__(target_action=target_action, on_stdout=on_stdout)
        self._actions = list(actions) if isinstance(actions, Iterable) else [actions]

    def describe(self) -> tuple[str, list[LaunchDescriptionEntity]]:
        """Return a description and the actions, which may contain the ReadyToTest."""
        return super().describe()[0], self._actions


__getattr__ = make_getattr(__name__)
