"""Describes violations of a JSON schema in sentences.

For `anyOf`, `pattern` and similar keywords, the sentence is the `description` beside them in the schema.
"""

from __future__ import annotations

import difflib
import json
from collections.abc import Iterable, Iterator, Mapping
from functools import cache
from pathlib import Path
from typing import Any

from jsonschema import Draft202012Validator, ValidationError

KeyPath = tuple[str, ...]  # the keys and indices that lead to a part of the data
SCHEMAS = Path(__file__).with_name("files.schema.json")
TYPE_NAMES = {
    "object": "a mapping",
    "array": "a list",
    "string": "a string",
    "integer": "a whole number",
    "boolean": "true or false",
}
INSTANCE_NAMES = (
    (bool, "true or false"),
    (str, "a string"),
    ((int, float), "a number"),
    (Mapping, "a mapping"),
    (list, "a list"),
)


def schema_violations(data: Any, schema: Mapping[str, Any], whole: str = "the file") -> list[tuple[KeyPath, str]]:
    """Return a key path and a sentence for each part of the data that violates the schema.

    Sentences refer to the data as a whole by the text `whole`, and to a part by its key path.
    """
    violations: dict[tuple[KeyPath, str], None] = {}
    for error in sorted(
        Draft202012Validator(schema).iter_errors(data), key=lambda violation: [*map(str, violation.path)]
    ):
        path = tuple(map(str, error.absolute_path))
        subject = f"`{_format_path(path)}`{_id_in_brackets(data, error)}" if path else whole
        for extra_path, sentence in _sentences(error, subject):
            violations.setdefault(((*path, *extra_path), sentence))
    return list(violations)


@cache
def file_schema(name: str) -> dict[str, Any]:
    """Return the schema for files with this name, such as `mutants.yaml`."""
    schemas: dict[str, Any] = json.loads(SCHEMAS.read_text(encoding="utf-8"))
    return {"$ref": f"#/$defs/{name}", "$defs": schemas["$defs"]}


def suggestion(name: str, known_names: Iterable[str]) -> str:
    """Return the end of a sentence about an unknown name: a similar known name, or all known names."""
    known_names = list(known_names)
    matches = difflib.get_close_matches(name, known_names, n=1)
    return f"did you mean `{matches[0]}`?" if matches else f"the known names are {', '.join(known_names) or 'none'}"


def _sentences(error: Any, subject: str) -> Iterator[tuple[KeyPath, str]]:
    """Yield sentences for an error of jsonschema, which may concern several keys of its `subject`."""
    schema, rule, expected, instance = error.schema, error.validator, error.validator_value, error.instance
    if rule == "additionalProperties" and expected is False:
        known_keys = list(schema["properties"])
        for key in (str(entry) for entry in instance if entry not in known_keys):
            yield (key,), f"{subject} has an unknown key `{key}`: {suggestion(key, known_keys)}"
    elif rule == "required":
        for key in expected:
            if key not in instance:
                yield (), f"{subject} has no `{key}`"
    elif rule == "dependentRequired":
        for key, dependents in expected.items():
            for dependent in dependents if key in instance else ():
                if dependent not in instance:
                    yield (), f"{subject} has `{key}`, but no `{dependent}`"
    elif rule == "type":
        names = [TYPE_NAMES[name] for name in ([expected] if isinstance(expected, str) else expected)]
        advice = ": put it in quotes" if "string" in expected and not isinstance(instance, (Mapping, list)) else ""
        actual = next((name for kind, name in INSTANCE_NAMES if isinstance(instance, kind)), "empty")
        yield (), f"{subject} must be {' or '.join(names)}, not {actual}{'' if instance is None else advice}"
    elif rule == "minItems":
        yield (), f"{subject} needs {expected} entries, but has {len(instance)}"
    else:
        yield (), f"{subject}: {schema.get('description', error.message)}"


def _format_path(path: KeyPath) -> str:
    """Return a key path in readable form: `mutants[2].edits[0].find`."""
    return "".join(f"[{part}]" if part.isdigit() else f".{part}" for part in path).lstrip(".")


def _id_in_brackets(data: Any, error: ValidationError) -> str:
    """Return the `id` of the innermost enclosing mapping that has one, in brackets, or an empty string."""
    innermost_id, part = "", data
    for key in error.absolute_path:
        part = part[key]
        if isinstance(part, Mapping) and isinstance(part.get("id"), str):
            innermost_id = f" ({part['id']})"
    return innermost_id
