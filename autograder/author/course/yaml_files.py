"""Reads the YAML files of a course: their data, the line of each part, and their problems."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import yaml

from autograder.author.course.exceptions import CourseError
from autograder.author.course.findings import Finding, display_path
from autograder.author.course.schema_sentences import KeyPath, file_schema, schema_violations

LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)  # equivalent; the C version is ten times as fast


@dataclass(frozen=True)
class YamlFile:
    """The content of a YAML file.

    Attributes:
        label: its path in findings.
        data: its data, or None if it is empty or unusable.
        lines: the line of each key and list entry, by its key path.
        findings: its problems. If there are none, the data match the schema.
    """

    label: str
    data: Any
    lines: Mapping[KeyPath, int]
    findings: tuple[Finding, ...] = ()

    def finding(self, path: KeyPath, message: str) -> Finding:
        """Return a finding at a key path, or at the innermost enclosing part if the file lacks this path."""
        enclosing_paths = (path[:length] for length in range(len(path), 0, -1))
        return Finding(
            self.label, None, message, next((self.lines[part] for part in enclosing_paths if part in self.lines), 1)
        )


def read_yaml(path: Path, *, label: str = "", schema: str = "") -> YamlFile:
    """Read an existing YAML file.

    Args:
        path: the file.
        label: its path in findings, by default relative to the course.
        schema: name of its schema in `files.schema.json`, by default the file's name.
    """
    label = label or display_path(path)
    try:
        loader = LOADER(path.read_text(encoding="utf-8"))
        root = loader.get_single_node()
        data = None if root is None else loader.construct_document(root)
    except UnicodeDecodeError as error:
        return YamlFile(label, None, {}, (Finding(label, None, f"is not UTF-8 text: {error.reason}", 1),))
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        context = f", {error.context}" if error.context else ""
        message = f"cannot be read as YAML: {error.problem}{context}"
        return YamlFile(label, None, {}, (Finding(label, None, message, mark.line + 1 if mark else 1),))
    except (yaml.YAMLError, ValueError) as error:  # for example, a character that YAML forbids or an invalid date
        return YamlFile(label, None, {}, (Finding(label, None, f"cannot be read as YAML: {error}", 1),))
    lines: dict[KeyPath, int] = {}
    duplicates = [] if root is None else list(_walk(root, (), lines))
    file = YamlFile(label, data, lines)
    problems = [(key, f"`{key[-1]}` occurs twice: only the last one would count") for key in duplicates]
    problems += schema_violations(data, file_schema(schema or path.name))
    return replace(file, findings=tuple(file.finding(key, message) for key, message in problems))


def load_yaml(path: Path, *, schema: str = "") -> Any:
    """Return the data of a YAML file.

    Raises:
        CourseError: it is not YAML, or violates its schema. The message lists all problems, line by line.
    """
    file = read_yaml(path, label=str(path), schema=schema)
    if file.findings:
        raise CourseError("\n".join(map(str, file.findings)))
    return file.data


def _walk(node: yaml.Node, path: KeyPath, lines: dict[KeyPath, int]) -> Iterator[KeyPath]:
    """Add the lines of all parts of a node to `lines`, and yield the key paths of duplicate keys."""
    if isinstance(node, yaml.SequenceNode):
        for index, entry in enumerate(node.value):
            part = (*path, str(index))
            lines[part] = entry.start_mark.line + 1
            yield from _walk(entry, part, lines)
    elif isinstance(node, yaml.MappingNode):
        for key, value in node.value:
            part = (*path, str(key.value))
            if part in lines:
                yield part
            lines[part] = key.start_mark.line + 1
            yield from _walk(value, part, lines)
