"""The action that runs a command."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ..descriptions import Environment, Executable
from ..substitution import SomeSubstitutionsType, Substitution, describe_substitutions
from .execute_local import ExecuteLocal


class ExecuteProcess(ExecuteLocal):
    """Runs a command; see `ExecuteLocal` for its process and `Executable` for its description."""

    def __init__(
        self,
        *,
        cmd: Iterable[SomeSubstitutionsType],
        prefix: SomeSubstitutionsType | None = None,
        name: SomeSubstitutionsType | None = None,
        cwd: SomeSubstitutionsType | None = None,
        env: Environment | None = None,
        additional_env: Environment | None = None,
        **kwargs: Any,
    ) -> None:
        description = Executable(cmd=cmd, prefix=prefix, name=name, cwd=cwd, env=env, additional_env=additional_env)
        super().__init__(process_description=description, **kwargs)

    @property
    def cmd(self) -> list[list[Substitution]]:
        """The command, with its substitutions."""
        return self.process_description.cmd

    @property
    def cwd(self) -> list[Substitution] | None:
        """The working directory."""
        return self.process_description.cwd

    @property
    def env(self) -> list[tuple[list[Substitution], list[Substitution]]] | None:
        """The environment, or None if the process inherits it."""
        return self.process_description.env

    @property
    def name(self) -> str:
        """The name of the process, e.g. ``echo-1``; empty before it is started."""
        return self.process_description.final_name

    def describe(self) -> str:
        """Return a description with the command."""
        command = ", ".join(describe_substitutions(part) for part in self.cmd)
        cwd = None if self.cwd is None else f"'{describe_substitutions(self.cwd)}'"
        env: str | None = None
        if self.env is not None:
            pairs = (f"{describe_substitutions(k)}: {describe_substitutions(v)}" for k, v in self.env)
            env = "{" + ", ".join(pairs) + "}"
        return f"ExecuteProcess(cmd=[{command}], cwd={cwd}, env={env}, shell={self.shell})"
