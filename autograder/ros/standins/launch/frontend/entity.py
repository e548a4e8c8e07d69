"""One element of an XML or YAML launch file, such as an action with its attributes."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any

from standin_notice import make_getattr


class Entity(ABC):
    """An element with a type, attributes and children, which records the ones that were read."""

    @property
    @abstractmethod
    def type_name(self) -> str:
        """The type, for example ``node``."""

    @property
    @abstractmethod
    def parent(self) -> Entity | None:
        """The element that contains this one."""

    @property
    @abstractmethod
    def children(self) -> list[Entity]:
        """The elements that this one contains."""

    @abstractmethod
    def assert_entity_completely_parsed(self) -> None:
        """Raise ValueError if an attribute or a child was not read, because the action does not have it."""

    @abstractmethod
    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute.

        Args:
            name: the name of the attribute.
            data_type: `str`, `int`, `float`, `bool`, a list of one of these, `list[Entity]` for the children of that
                name, or None for YAML's rules.
            optional: return None if the attribute is missing.
            can_be_str: return text that does not have the type unchanged, as it may contain a substitution.

        Raises:
            AttributeError: the attribute is missing.
            TypeError: it does not have the type.
        """


__getattr__ = make_getattr(__name__)
