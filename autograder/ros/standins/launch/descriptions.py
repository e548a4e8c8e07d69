"""Descriptions of processes: a command with its name, folder and environment, expanded when it is started."""

from __future__ import annotations

import itertools
import re
import shlex
from collections.abc import Iterable, Mapping
from pathlib import PurePath
from typing import TYPE_CHECKING

from standin_notice import make_getattr

from .launch_context import LaunchContext
from .substitution import (
    SomeSubstitutionsType,
    Substitution,
    normalize_to_list_of_substitutions,
    perform_substitutions,
)
from .substitutions import LaunchConfiguration

if TYPE_CHECKING:
    from .action import Action

_counter = itertools.count(1)
Environment = Mapping[SomeSubstitutionsType, SomeSubstitutionsType]
_Pairs = list[tuple[list[Substitution], list[Substitution]]]


def _pairs(environment: Environment | None) -> _Pairs | None:
    if environment is None:
        return None
    return [
        (normalize_to_list_of_substitutions(name), normalize_to_list_of_substitutions(value))
        for name, value in environment.items()
    ]


class Executable:
    """An executable with its arguments; `prepare` sets the `final_…` attributes."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        arguments: Iterable[SomeSubstitutionsType] | None = None,
    ) -> None:
        if isinstance(cmd, (str, Substitution)):
            raise TypeError(f"cmd must be a list such as ['echo', 'hello'], got {type(cmd).__name__}: {cmd!r}")
        self.arguments = list(arguments or ())
        self.cmd = [normalize_to_list_of_substitutions(part) for part in [*cmd, *self.arguments]]
        # Without a prefix of its own, it gets the configured one if the filter matches.
        self.prefix_is_configured = prefix is None
        self.prefix = normalize_to_list_of_substitutions(
            LaunchConfiguration("launch-prefix", default="") if prefix is None else prefix
        )
        self.name = None if name is None else normalize_to_list_of_substitutions(name)
        self.cwd = None if cwd is None else normalize_to_list_of_substitutions(cwd)
        self.env = _pairs(env)
        self.additional_env = _pairs(additional_env)
        self.final_cmd: list[str] = []
        self.final_name = ""
        self.final_cwd: str | None = None
        self.final_env: dict[str, str] = {}

    def prepare(self, context: LaunchContext, action: Action) -> None:
        """Perform all substitutions, and number the process."""
        cmd = [perform_substitutions(context, part) for part in self.cmd]
        executable = PurePath(cmd[0]).name
        if self._has_prefix(context, executable):
            cmd = shlex.split(perform_substitutions(context, self.prefix)) + cmd
        self.final_cmd = cmd
        name = PurePath(cmd[0]).name if self.name is None else perform_substitutions(context, self.name)
        self.final_name = f"{name}-{next(_counter)}"
        self.final_cwd = None if self.cwd is None else perform_substitutions(context, self.cwd)
        self.final_env = self._environment(context)

    def _has_prefix(self, context: LaunchContext, executable: str) -> bool:
        if not self.prefix_is_configured:
            return True
        pattern = LaunchConfiguration("launch-prefix-filter", default="").perform(context)
        return re.match(pattern, executable) is not None

    def _environment(self, context: LaunchContext) -> dict[str, str]:
        environment = dict(context.environment) if self.env is None else {}
        for name, value in [*(self.env or ()), *(self.additional_env or ())]:
            environment[perform_substitutions(context, name)] = perform_substitutions(context, value)
        return environment


__getattr__ = make_getattr(__name__)
