"""The names of actions and substitutions in XML and YAML launch files."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, TypeVar

from ..substitution import Substitution

if TYPE_CHECKING:
    from ..action import Action
    from .entity import Entity
    from .parser import Parser

Exposed = TypeVar("Exposed", bound=Callable[..., Any])
Parse = Callable[..., tuple[Callable[..., Any], dict[str, Any]]]

action_parse_methods: dict[str, Parse] = {}
substitution_parse_methods: dict[str, Parse] = {}


def instantiate_action(entity: Entity, parser: Parser) -> Action:
    """Return the action that an element describes; raise RuntimeError for an unknown type."""
    if entity.type_name not in action_parse_methods:
        raise RuntimeError(f"Unrecognized entity of the type: {entity.type_name}")
    factory, arguments = action_parse_methods[entity.type_name](entity, parser)
    action: Action = factory(**arguments)
    return action


def instantiate_substitution(type_name: str, arguments: Sequence[Sequence[Substitution]] = ()) -> Substitution:
    """Return the substitution with this name and its arguments; raise RuntimeError for an unknown name."""
    if type_name not in substitution_parse_methods:
        raise RuntimeError(f"Unknown substitution: {type_name}")
    factory, keywords = substitution_parse_methods[type_name](arguments)
    substitution: Substitution = factory(**keywords)
    return substitution


def expose_action(name: str) -> Callable[[Exposed], Exposed]:
    """Return a decorator that registers a class of actions, or a function that parses one, by its name in launch files.

    The decorator raises RuntimeError if a class has no class method `parse`, or if the name is taken.
    """

    def expose(exposed: Exposed) -> Exposed:
        parse = _parse_method(exposed, "action", name)

        @functools.wraps(parse)
        def parse_completely(entity: Entity, parser: Parser) -> Any:
            parsed = parse(entity, parser)
            entity.assert_entity_completely_parsed()
            return parsed

        _add(action_parse_methods, name, parse_completely, "action")
        return exposed

    return expose


def expose_substitution(name: str) -> Callable[[Exposed], Exposed]:
    """Return a decorator that registers a class of substitutions, or a function that parses one, by its name in text.

    The decorator raises RuntimeError if a class has no class method `parse`, or if the name is taken.
    """

    def expose(exposed: Exposed) -> Exposed:
        _add(substitution_parse_methods, name, _parse_method(exposed, "substitution", name), "substitution")
        return exposed

    return expose


def _parse_method(exposed: Any, kind: str, name: str) -> Parse:
    if inspect.isfunction(exposed):
        return exposed
    if not inspect.isclass(exposed):
        raise RuntimeError(f"Exposed {kind} parser for {name} is not a callable or a class containing a parse method")
    parse = getattr(exposed, "parse", None)
    if not inspect.ismethod(parse):
        raise RuntimeError("Did not find a class method called 'parse' in the class being decorated.")
    return parse


def _add(methods: dict[str, Parse], name: str, parse: Parse, kind: str) -> None:
    if inspect.unwrap(methods.get(name, parse)) != inspect.unwrap(parse):
        raise RuntimeError(f"Two {kind} parsing methods exposed with the same name: [{name}].")
    methods[name] = parse
