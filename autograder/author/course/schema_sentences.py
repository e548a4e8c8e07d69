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

Place = tuple[str, ...]  # keys and indices from the top of the data to a part of them
SCHEMAS = Path(__file__).with_name("files.schema.json")
IN_WORDS = {
    "object": "a mapping",
    "array": "a list",
    "string": "a text",
    "integer": "a whole number",
    "boolean": "true or false",
}
KINDS = ((bool, "true or false"), (str, "a text"), ((int, float), "a number"), (Mapping, "a mapping"), (list, "a list"))


def broken_schema(data: Any, schema: Mapping[str, Any], whole: str = "the file") -> Iterator[tuple[Place, str]]:
    """Yield each place in plain data that violates a schema, with a sentence. Each sentence is yielded once.

    Sentences refer to the whole data as `whole`, and to a part by its place.
    """
    told: dict[tuple[Place, str], None] = {}
    for error in sorted(Draft202012Validator(schema).iter_errors(data), key=lambda each: [*map(str, each.path)]):
        place = tuple(map(str, error.absolute_path))
        here = f"`{_named(place)}`{_id(data, error)}" if place else whole
        for more, sentence in _sentences(error, here):
            told.setdefault(((*place, *more), sentence))
    yield from told


@cache
def file_schema(name: str) -> dict[str, Any]:
    """Return the schema for files with this name, such as `mutants.yaml`."""
    schemas: dict[str, Any] = json.loads(SCHEMAS.read_text(encoding="utf-8"))
    return {"$ref": f"#/$defs/{name}", "$defs": schemas["$defs"]}


def meant(name: str, known: Iterable[str]) -> str:
    """Return the end of a sentence about an unknown name: a similar known name, or all known names."""
    known = list(known)
    close = difflib.get_close_matches(name, known, n=1)
    return f"did you mean `{close[0]}`?" if close else f"there are: {', '.join(known) or 'none'}"


def _sentences(error: Any, here: str) -> Iterator[tuple[Place, str]]:
    """Yield sentences for an error of jsonschema, which may concern several keys below the place `here`."""
    schema, rule, expected, instance = error.schema, error.validator, error.validator_value, error.instance
    if rule == "additionalProperties" and expected is False:
        known = list(schema["properties"])
        for key in (str(each) for each in instance if each not in known):
            yield (key,), f"{here} has an unknown key `{key}`: {meant(key, known)}"
    elif rule == "required":
        for key in expected:
            if key not in instance:
                yield (), f"{here} has no `{key}`"
    elif rule == "dependentRequired":
        for key, others in expected.items():
            for other in others if key in instance else ():
                if other not in instance:
                    yield (), f"{here} has `{key}`, and no `{other}`"
    elif rule == "type":
        names = [IN_WORDS[name] for name in ([expected] if isinstance(expected, str) else expected)]
        quoted = ": put it in quotes" if "string" in expected and not isinstance(instance, (Mapping, list)) else ""
        yield (), f"{here} must be {' or '.join(names)}, not {_kind(instance)}{'' if instance is None else quoted}"
    elif rule == "minItems":
        yield (), f"{here} needs {expected} entries, and has {len(instance)}"
    else:
        yield (), f"{here}: {schema.get('description', error.message)}"


def _named(place: Place) -> str:
    """Return a place in readable form: `mutants[2].edits[0].find`."""
    return "".join(f"[{part}]" if part.isdigit() else f".{part}" for part in place).lstrip(".")


def _id(data: Any, error: ValidationError) -> str:
    """Return the `id` of the innermost enclosing mapping that has one, in brackets, or an empty string."""
    innermost, inside = "", data
    for part in error.absolute_path:
        inside = inside[part]
        if isinstance(inside, Mapping) and isinstance(inside.get("id"), str):
            innermost = f" ({inside['id']})"
    return innermost


def _kind(value: object) -> str:
    return next((name for kind, name in KINDS if isinstance(value, kind)), "empty")
