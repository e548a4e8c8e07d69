"""Counts the steps that a backtracking regular expression takes, and makes texts that are hard for it.

`Steps` executes Python's own parse tree, one step for each character or alternative that is tried. A count is the
same on every machine, which a time is not. A bound such as `{1,200}` counts as `{1,8}`: a bounded repetition
is a constant factor, and short texts have to show it as one.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Callable, Iterator
from functools import partial
from itertools import product
from typing import Any

if sys.version_info >= (3, 11):
    from re import _parser as sre
else:
    import sre_parse as sre

BOUND = 8
_SPACE, _WORD = set(" \t\n\r\f\v"), set("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_")
# One character of each kind; the first one in a class represents the class.
ALPHABET = "a1 A_.-/\n\t[]:'\"<>=,;(){}#*+~|`\\&%$@!?^0é\x1b\x07\x00"
Then = Callable[[int], bool]


class Budget(Exception):
    """The pattern has taken more steps than a linear one could need."""


class Steps:
    """One pattern, and how many steps it has taken so far."""

    def __init__(self, pattern: re.Pattern[Any], limit: int) -> None:
        text = pattern.pattern.decode("latin-1") if isinstance(pattern.pattern, bytes) else pattern.pattern
        self.flags, self.limit, self.count = pattern.flags, limit, 0
        self.tree = sre.parse(text, pattern.flags & ~re.UNICODE & ~re.LOCALE)
        self.text = ""
        self.matches: list[tuple[int, int]] = []
        self.groups: dict[int, tuple[int, int]] = {}

    def search(self, text: str, *, anchored: bool, full: bool) -> int:
        """Return the steps of all matches in a text, one after the other, or of one at its beginning."""
        self.text, start = text, 0
        while start <= len(text):
            self._count()
            end: list[int] = []

            def accept_end(at: int, end: list[int] = end) -> bool:
                if full and at < len(self.text):
                    return False
                end.append(at)
                return True

            self._all(self.tree.data, 0, start, accept_end)
            self.matches += [(start, end[0])] if end else []
            if anchored:
                break
            start = max(end[0], start + 1) if end else start + 1
        return self.count

    def _count(self) -> None:
        self.count += 1
        if self.count > self.limit:
            raise Budget

    def _all(self, nodes: list[Any], index: int, start: int, continuation: Then) -> bool:
        if index == len(nodes):
            return continuation(start)
        return self._one(nodes[index], start, lambda after: self._all(nodes, index + 1, after, continuation))

    def _one(self, node: Any, start: int, continuation: Then) -> bool:
        self._count()
        kind, value = str(node[0]), node[1]
        if kind in ("LITERAL", "NOT_LITERAL", "ANY", "IN"):
            return start < len(self.text) and fits(node, self.text[start], self.flags) and continuation(start + 1)
        if kind in ("MAX_REPEAT", "MIN_REPEAT"):
            low, high, item = value[0], int(value[1]), list(value[2])
            if high != int(sre.MAXREPEAT):
                low, high = min(low, BOUND), min(high, BOUND)
            return self._repeat(item, low, high, start, continuation, greedy=kind == "MAX_REPEAT")
        if kind == "SUBPATTERN":

            def close_group(after: int) -> bool:
                before = self.groups.get(value[0])
                self.groups[value[0]] = (start, after)
                if continuation(after):
                    return True
                self.groups[value[0]] = before or (0, 0)
                return False

            return self._all(list(value[3]), 0, start, close_group)
        if kind == "BRANCH":
            return any(self._all(list(branch), 0, start, continuation) for branch in value[1])
        if kind in ("ASSERT", "ASSERT_NOT"):
            ahead, inner = value[0] > 0, list(value[1])
            width = value[1].getwidth()[0]
            matched = start >= width and self._all(inner, 0, start if ahead else start - width, lambda _: True)
            return matched is (kind == "ASSERT") and continuation(start)
        if kind == "AT":
            return self._anchor(str(value), start) and continuation(start)
        if kind == "GROUPREF":
            begin, end = self.groups.get(value, (0, 0))
            self.count += end - begin
            return self.text.startswith(self.text[begin:end], start) and continuation(start + end - begin)
        raise NotImplementedError(kind)

    def _repeat(self, item: list[Any], low: int, high: int, at: int, continuation: Then, *, greedy: bool) -> bool:
        if len(item) == 1 and str(item[0][0]) in ("LITERAL", "NOT_LITERAL", "ANY", "IN"):
            return self._repeat_one(item[0], low, high, at, continuation, greedy=greedy)

        def match_more(count: int, position: int) -> bool:
            def match_after(after: int) -> bool:
                return (after > position or count < low) and match_more(count + 1, after)

            if count < low:
                return self._all(item, 0, position, match_after)
            if greedy:
                return (count < high and self._all(item, 0, position, match_after)) or continuation(position)
            return continuation(position) or (count < high and self._all(item, 0, position, match_after))

        return match_more(0, at)

    def _repeat_one(self, item: Any, low: int, high: int, at: int, continuation: Then, *, greedy: bool) -> bool:
        """Repeat a single character without a call for each repetition, as Python does."""
        position = at
        while (
            greedy
            and position - at < high
            and position < len(self.text)
            and fits(item, self.text[position], self.flags)
        ):
            self._count()
            position += 1
        if greedy:
            return any(continuation(end) for end in range(position, at + low - 1, -1))
        while position - at <= high:
            self._count()
            if position - at >= low and continuation(position):
                return True
            if position >= len(self.text) or not fits(item, self.text[position], self.flags):
                return False
            position += 1
        return False

    def _anchor(self, name: str, at: int) -> bool:
        text = self.text
        if name == "AT_BEGINNING":
            return at == 0 or bool(self.flags & re.MULTILINE and text[at - 1] == "\n")
        if name == "AT_BEGINNING_STRING":
            return at == 0
        if name == "AT_END":
            return at == len(text) or (text[at] == "\n" and (at == len(text) - 1 or bool(self.flags & re.MULTILINE)))
        if name == "AT_END_STRING":
            return at == len(text)
        word = (at > 0 and text[at - 1] in _WORD) is not (at < len(text) and text[at] in _WORD)
        return word is (name == "AT_BOUNDARY")


def fits(node: Any, char: str, flags: int) -> bool:
    """Return whether a node for one character matches this character."""
    kind, value = str(node[0]), node[1]
    if kind == "ANY":
        return char != "\n" or bool(flags & re.DOTALL)
    if kind in ("LITERAL", "NOT_LITERAL"):
        is_equal = chr(value) == char or bool(flags & re.IGNORECASE and chr(value).lower() == char.lower())
        return is_equal is (kind == "LITERAL")
    negated = any(str(part[0]) == "NEGATE" for part in value)
    return negated is not any(_in_class(part, char, flags) for part in value if str(part[0]) != "NEGATE")


def _in_class(part: Any, char: str, flags: int) -> bool:
    kind, value = str(part[0]), part[1]
    if kind == "RANGE":
        chars = (char, char.swapcase()) if flags & re.IGNORECASE else (char,)
        return any(len(variant) == 1 and value[0] <= ord(variant) <= value[1] for variant in chars)
    if kind == "CATEGORY":
        name = str(value).removeprefix("CATEGORY_")
        members = {"SPACE": _SPACE, "WORD": _WORD, "DIGIT": set("0123456789")}[name.removeprefix("NOT_")]
        return (char in members) is not name.startswith("NOT_")
    return fits(part, char, flags)


def hard_texts(pattern: re.Pattern[Any], *, full: bool) -> Iterator[Callable[[int], str]]:
    """Yield texts, as functions of a number of repetitions, that are built from the pattern's own characters.

    Each is the beginning of a text that matches, then a part that is repeated, then an end that does not match. The
    part is a character of the pattern, or a piece of a matching text.
    """
    maker = Steps(pattern, 0)
    samples = [_sample(maker.tree.data, maker.flags, {}, repetitions) for repetitions in (0, 1)]
    literals = (_char(node, maker.flags) for node in _walk(maker.tree.data))
    chars = sorted({*literals, *"".join(samples)} - {""})
    heads, pairs = {""}, set[str]()
    for sample in samples:
        cut = [at for at in range(1, len(sample)) if not (sample[at - 1].isalnum() and sample[at].isalnum())]
        heads |= {sample[:at] for at in [*cut[:10], len(sample)]}
        pairs |= {sample[at - 1 : at + 1] for at in cut[:12]}
    lines = {f"{head}\n" for head in heads} if maker.flags & re.MULTILINE else set()
    parts = {*chars[:16], *pairs, *heads, *lines} - {""}
    tails = ("\0", '"\0"\0') if full else ("\0",)  # the second has characters that a class such as [^"'] excludes
    for head, part, tail in product(sorted(heads, key=len)[:8], sorted(parts), tails):
        yield partial(_repeated, head, part, tail)


def _repeated(head: str, part: str, tail: str, count: int) -> str:
    return head + part * count + tail


def _walk(nodes: Any) -> Iterator[Any]:
    for node in nodes:
        if isinstance(node, tuple) and len(node) == 2 and type(node[0]).__name__ == "_NamedIntConstant":
            yield node
            value = node[1]
            if isinstance(value, tuple | list):
                for part in value:
                    if isinstance(part, sre.SubPattern):
                        yield from _walk(part)
                    elif isinstance(part, list):
                        yield from (
                            inner for branch in part if isinstance(branch, sre.SubPattern) for inner in _walk(branch)
                        )


def _char(node: Any, flags: int) -> str:
    if str(node[0]) == "LITERAL":
        return chr(node[1])
    if str(node[0]) in ("NOT_LITERAL", "ANY", "IN"):
        return next((char for char in ALPHABET if fits(node, char, flags)), "")
    return ""


def _sample(nodes: list[Any], flags: int, groups: dict[int, str], repetitions: int) -> str:
    """Return a text that matches, or almost: each part that may repeat occurs `repetitions` times."""
    text = ""
    for node in nodes:
        kind, value = str(node[0]), node[1]
        if kind in ("MAX_REPEAT", "MIN_REPEAT"):
            text += _sample(list(value[2]), flags, groups, repetitions) * min(max(repetitions, value[0]), BOUND)
        elif kind == "SUBPATTERN":
            groups[value[0]] = _sample(list(value[3]), flags, groups, repetitions)
            text += groups[value[0]]
        elif kind == "BRANCH":
            text += _sample(list(value[1][0]), flags, groups, repetitions)
        elif kind == "ASSERT" and value[0] > 0:
            text += _sample(list(value[1]), flags, groups, repetitions)
        elif kind == "GROUPREF":
            text += groups.get(value, "")
        else:
            text += _char(node, flags)
    return text
