"""Mutation operators for files other than Python: interface definitions, build files, manifests and parameters."""

from __future__ import annotations

import re
from collections.abc import Iterator

from autograder.author.verification.python_operators import Mutation, numbers

# Each type of a field, and the type that replaces it; below, the same for the tags of manifests.
TYPES = {
    "float64": "float32",
    "float32": "float64",
    "int32": "int64",
    "int64": "int32",
    "bool": "uint8",
    "string": "wstring",
}
TAGS = {"depend": "build_depend", "exec_depend": "build_depend", "build_depend": "exec_depend"}
TAGS |= {"test_depend": "exec_depend", "buildtool_depend": "build_depend"}
NUMBER = re.compile(r"(?<![\w.<])\d+(?:\.\d+)?(?![\w.])")
DEFINITION = re.compile(r"(?P<type>[a-z_0-9A-Z/]+)(?P<bound>\[[^]]*\]|<=\d+)?(?P<rest>\[[^]]*\])?\s+(?P<name>\w+)")
NAME_VALUE = re.compile(r">(?P<value>[^<>\n]+)</|=(?P<attribute>\"[^\"\n]*)\"")
TAG = re.compile(r"<(?P<tag>\w+)>(?P<text>[^<>\n]+)</(?P=tag)>")
WORD = re.compile(r"[\w./${}-]+")
# The text of these tags is for people, or for tools that students do not run.
SKIPPED_TAGS = ("<description>", "<maintainer", "<?xml")


def text_mutations(file: str, text: str) -> Iterator[Mutation]:
    """Yield the mutations of a text, depending on its file type. Offsets are in bytes."""
    offset = 0
    previous_line: tuple[int, str] | None = None  # the offset and text of the previous line
    for line in text.splitlines(keepends=True):
        code = line if file.endswith((".xml", ".cfg")) else line.split("#")[0].rstrip() + "\n"
        if code.strip() and not line.startswith(SKIPPED_TAGS, len(line) - len(line.lstrip())):
            yield "no line", ((offset, offset + len(line.encode()), ""),)
            for name, start, end, new in _in_line(file, code):
                begin = offset + len(code[:start].encode())
                yield name, ((begin, begin + len(code[start:end].encode()), new),)
            if previous_line and file.endswith((".msg", ".srv", ".action")):
                swapped_lines = line + previous_line[1]
                yield "line order", ((previous_line[0], offset + len(line.encode()), swapped_lines),)
            previous_line = offset, line
        offset += len(line.encode())


def _in_line(file: str, line: str) -> Iterator[tuple[str, int, int, str]]:
    """Yield (operator, start, end, new text) for each mutation of a line."""
    if file.endswith((".msg", ".srv", ".action")):
        yield from _in_definition(line)
    elif file.endswith(".xml"):
        for match in NAME_VALUE.finditer(line):
            end = match.end() - (2 if match["value"] else 1)
            yield "name", end, end, "s"
        if (tag := TAG.search(line)) and tag["tag"] in TAGS:
            new = TAGS[tag["tag"]]
            yield "tag", tag.start(), tag.end(), f"<{new}>{tag['text']}</{new}>"
    elif file.endswith(("CMakeLists.txt", ".cfg")):
        yield from (("name", word.end(), word.end(), "s") for word in WORD.finditer(line))
    elif file.endswith((".yaml", ".yml")):
        key, colon, value = line.partition(":")
        yield "name", len(key), len(key), "s"
        yield from _numbers(value, len(key) + len(colon))
        if (word := value.strip()) and not NUMBER.fullmatch(word.lstrip("-")):
            end = len(line.rstrip()) - (word[-1] in "'\"")
            yield "value", end, end, "s"


def _in_definition(line: str) -> Iterator[tuple[str, int, int, str]]:
    match = DEFINITION.match(line)
    if match is None:
        return
    if match["type"] in TYPES:
        yield "type", *match.span("type"), TYPES[match["type"]]
    yield "name", match.end("name"), match.end("name"), "S" if match["name"].isupper() else "s"
    for bound in ("bound", "rest"):
        if match[bound]:
            yield "bound", *match.span(bound), "[]" if match[bound].startswith("[<") else ""
            if number := NUMBER.search(match[bound].replace("<=", "  ")):
                start = match.start(bound) + number.start()
                yield "bound", start, start + len(number[0]), str(int(number[0]) + 1)
    yield from _numbers(line[match.end("name") :], match.end("name"))


def _numbers(text: str, offset: int) -> Iterator[tuple[str, int, int, str]]:
    for match in NUMBER.finditer(text):
        value = float(match[0]) if "." in match[0] else int(match[0])
        is_negative = text[: match.start()].rstrip().endswith("-")
        for name, new in numbers(value):
            if not (is_negative and new.startswith("(")):
                yield name, offset + match.start(), offset + match.end(), new.strip("()")
