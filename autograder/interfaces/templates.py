"""Spares the generators most of their time: a template that several interfaces share is scanned once, not for each.

rosidl's generators expand dozens of templates of empy's, most of them for every interface and some for every field,
and empy reads each anew, a character at a time. What it finds depends on the text alone, as long as no template
changes empy's configuration, which rosidl's do not.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any


def scan_once() -> None:
    """Let empy remember what it has scanned. With empy 3, whose scanner is another, nothing changes."""
    if not import_module("rosidl_pycommon").em_has_configuration:
        return
    em = import_module("em")
    remembered: dict[str, list[Any]] = {}

    def string(interpreter: Any, text: str, locals: Any = None, dispatcher: Any = None) -> None:
        if text not in remembered:
            remembered[text] = _scanned(em, interpreter, text)
        interpreter.runSeveral(remembered[text], locals)

    em.Interpreter.string = string


def _scanned(em: Any, interpreter: Any, text: str) -> list[Any]:
    """Return a template's tokens; like empy, end one with a newline of its own where the last token asks for more."""
    scanner = em.Scanner(interpreter.config, interpreter.getContext(), interpreter.currents, text)
    tokens: list[Any] = []
    ended = False
    while True:
        try:
            token = scanner.one()
        except em.TransientParseError:
            if ended:
                raise
            ended = True
            scanner.feed(f"{interpreter.config.prefix}\n")
            continue
        if token is None:
            return tokens
        tokens.append(token)
