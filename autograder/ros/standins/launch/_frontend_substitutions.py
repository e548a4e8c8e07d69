"""The names and arguments of `launch`'s substitutions in text."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from .frontend import expose_substitution
from .substitution import Substitution, TextSubstitution
from .substitutions import (
    AllSubstitution,
    AndSubstitution,
    AnonName,
    AnySubstitution,
    Command,
    EnvironmentVariable,
    EqualsSubstitution,
    FileContent,
    FindExecutable,
    IfElseSubstitution,
    LaunchConfiguration,
    LaunchLogDir,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PythonExpression,
    ThisLaunchFile,
    ThisLaunchFileDir,
)

Arguments = Sequence[Sequence[Substitution]]


def name_substitution(name: str, cls: type[Substitution], *keywords: str) -> None:
    """Give a class of substitutions its name in text.

    Args:
        name: the name.
        cls: the class.
        keywords: the keyword of each argument, in order; one with ``?`` at its end is optional.
    """
    min_arguments = sum(not keyword.endswith("?") for keyword in keywords)
    count = str(min_arguments) if min_arguments == len(keywords) else f"{min_arguments} or {len(keywords)}"

    def parse(arguments: Arguments) -> tuple[type[Substitution], dict[str, Any]]:
        if not min_arguments <= len(arguments) <= len(keywords):
            raise TypeError(f"{name} substitution expects {count} argument{'s' * (len(keywords) != 1)}")
        return cls, {keyword.removesuffix("?"): value for keyword, value in zip(keywords, arguments, strict=False)}

    expose_substitution(name)(parse)


name_substitution("and", AndSubstitution, "left", "right")
name_substitution("anon", AnonName, "name")
name_substitution("command", Command, "command", "on_stderr?")
name_substitution("dirname", ThisLaunchFileDir)
name_substitution("env", EnvironmentVariable, "name", "default_value?")
name_substitution("equals", EqualsSubstitution, "left", "right")
name_substitution("file-content", FileContent, "path")
name_substitution("filename", ThisLaunchFile)
name_substitution("find-exec", FindExecutable, "name")
name_substitution("if", IfElseSubstitution, "condition", "if_value", "else_value?")
name_substitution("launch_log_dir", LaunchLogDir)
name_substitution("log_dir", LaunchLogDir)
name_substitution("not", NotSubstitution, "value")
name_substitution("not-equals", NotEqualsSubstitution, "left", "right")
name_substitution("or", OrSubstitution, "left", "right")
name_substitution("var", LaunchConfiguration, "variable_name", "default?")


@expose_substitution("eval")
def _eval(arguments: Arguments) -> tuple[type[Substitution], dict[str, Any]]:
    """Parse an expression and the names of modules, which are plain text and separated by commas."""
    if len(arguments) not in (1, 2):
        raise TypeError("eval substitution expects 1 or 2 arguments")
    keywords: dict[str, Any] = {"expression": arguments[0]}
    if len(arguments) == 2:
        names = "".join(part.text for part in arguments[1] if isinstance(part, TextSubstitution))
        keywords["python_modules"] = [name.strip() for name in names.split(",") if name.strip()]
    return PythonExpression, keywords


@expose_substitution("any")
def _any(arguments: Arguments) -> tuple[type[Substitution], dict[str, Any]]:
    """Raise TypeError for ``$(any ...)``, as in Jazzy, because AnySubstitution has no keyword ``args``."""
    return AnySubstitution, {"args": arguments}


@expose_substitution("all")
def _all(arguments: Arguments) -> tuple[type[Substitution], dict[str, Any]]:
    """Raise TypeError for ``$(all ...)``, as in Jazzy, because AllSubstitution has no keyword ``args``."""
    return AllSubstitution, {"args": arguments}
