"""Substitutions written in text, as parameter files have them: ``$(var name)``, ``$(env HOME)`` and so on."""

from __future__ import annotations

import re
import shlex
from collections.abc import Callable

from launch import LaunchContext, Substitution
from launch.substitutions import (
    Command,
    EnvironmentVariable,
    FindExecutable,
    LaunchConfiguration,
    PythonExpression,
    SubstitutionFailure,
    ThisLaunchFileDir,
)
from standin_notice import not_covered

from .substitutions import ExecutableInPackage, FindPackagePrefix, FindPackageShare

_KINDS: dict[str, Callable[..., Substitution]] = {
    "var": lambda name, default=None: LaunchConfiguration(name, default=default),
    "env": lambda name, default=None: EnvironmentVariable(name, default_value=default),
    "find-pkg-share": FindPackageShare,
    "find-pkg-prefix": FindPackagePrefix,
    "find-exec": lambda name: FindExecutable(name=name),
    "exec-in-pkg": ExecutableInPackage,
    "eval": PythonExpression,
    "command": Command,
    "dirname": ThisLaunchFileDir,
}
_WHOLE = ("eval", "command")
# The last one that begins in a text: no other begins inside of it.
_LAST = re.compile(r"\$\((?P<kind>[\w-]+)(?P<arguments>(?:[^()$]|\$(?!\()|\([^()$]*\))*)\)")
# Values are put in with other characters for these, so that nothing in a value is taken for a substitution.
_HIDE = str.maketrans("$()", "\ue000\ue001\ue002")
_SHOW = str.maketrans("\ue000\ue001\ue002", "$()")


def substitute_text(context: LaunchContext, text: str) -> str:
    """Return `text` with all its substitutions performed, inner ones before outer ones.

    Raises SubstitutionFailure for one that fails or is unfinished, NotInStandInError for a kind that is not
    covered.
    """
    while (position := text.rfind("$(")) >= 0:
        found = _LAST.match(text, position)
        if found is None:
            line = text[position:].splitlines()[0]
            raise SubstitutionFailure(f"this substitution has no end or cannot be read: {line}")
        value = _perform(context, found["kind"], found["arguments"].strip().translate(_SHOW))
        text = text[:position] + value.translate(_HIDE) + text[found.end() :]
    return text.translate(_SHOW)


def _perform(context: LaunchContext, kind: str, arguments: str) -> str:
    if kind not in _KINDS:
        raise not_covered(f"$({kind} ...)", standin="launch_ros")
    parts = [_unquoted(arguments)] if kind in _WHOLE else shlex.split(arguments)
    try:
        substitution = _KINDS[kind](*parts)
    except TypeError as error:
        raise SubstitutionFailure(f"$({kind} {arguments}): {error}") from error
    return substitution.perform(context)


def _unquoted(text: str) -> str:
    quoted = len(text) >= 2 and text[0] == text[-1] and text[0] in "'\""
    return text[1:-1] if quoted and text[0] not in text[1:-1] else text
