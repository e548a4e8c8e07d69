"""Reads a YAML file of a course: its data, the line of each part, and its problems."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import yaml

from autograder.author.course.findings import Finding
from autograder.author.course.schema_sentences import Place, broken_schema, file_schema

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # equivalent; the C version is ten times as fast


@dataclass(frozen=True)
class YamlFile:
    """The content of a YAML file.

    Attributes:
        shown: its path in findings.
        data: its data, or None if it is empty or unusable.
        lines: the line of each key and list entry, by its place.
        findings: its problems. If there are none, the data match the schema.
    """

    shown: str
    data: Any
    lines: Mapping[Place, int]
    findings: tuple[Finding, ...] = ()

    def finding(self, place: Place, message: str) -> Finding:
        """Return a finding at a place, or at the nearest enclosing place in the file."""
        around = (place[:length] for length in range(len(place), 0, -1))
        return Finding(self.shown, None, message, next((self.lines[p] for p in around if p in self.lines), 1))


def read_yaml(path: Path, shown: str, schema: str = "") -> YamlFile:
    """Read an existing YAML file.

    Args:
        path: the file.
        shown: its path in findings.
        schema: name of its schema in `files.schema.json`, by default the file's name.
    """
    try:
        loader = LOADER(path.read_text(encoding="utf-8"))
        top = loader.get_single_node()
        data = None if top is None else loader.construct_document(top)
    except UnicodeDecodeError as error:
        return YamlFile(shown, None, {}, (Finding(shown, None, f"is not text in UTF-8: {error.reason}", 1),))
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        context = f", {error.context}" if error.context else ""
        message = f"cannot be read as YAML: {error.problem}{context}"
        return YamlFile(shown, None, {}, (Finding(shown, None, message, mark.line + 1 if mark else 1),))
    except (yaml.YAMLError, ValueError) as error:  # a character that YAML forbids, or an invalid date
        return YamlFile(shown, None, {}, (Finding(shown, None, f"cannot be read as YAML: {error}", 1),))
    lines: dict[Place, int] = {}
    repeated = [] if top is None else list(_walk(top, (), lines))
    read = YamlFile(shown, data, lines)
    findings = [read.finding(place, f"`{place[-1]}` occurs twice: only the last one would count") for place in repeated]
    findings += [
        read.finding(place, message) for place, message in broken_schema(data, file_schema(schema or path.name))
    ]
    return YamlFile(shown, data, lines, tuple(findings))


def _walk(node: yaml.Node, place: Place, lines: dict[Place, int]) -> Iterator[Place]:
    """Add the lines of all parts of a node to `lines`, and yield the duplicate keys."""
    if isinstance(node, yaml.SequenceNode):
        for index, entry in enumerate(node.value):
            part = (*place, str(index))
            lines[part] = entry.start_mark.line + 1
            yield from _walk(entry, part, lines)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            part = (*place, str(key.value))
            if part in lines:
                yield part
            lines[part] = key.start_mark.line + 1
            yield from _walk(value, part, lines)
