"""The elements of YAML launch files."""

from __future__ import annotations

from typing import Any

from launch import frontend
from launch.frontend.type_utils import check_is_list_entity
from launch.utilities.type_utils import is_instance_of


class Entity(frontend.Entity):
    """A dictionary of attributes, or a list of elements."""

    def __init__(self, element: Any, type_name: str, *, parent: Entity | None = None) -> None:
        self._element = element
        self._type_name = type_name
        self._parent = parent
        self._read_names: set[str] = set()
        self._children_read = False

    @property
    def type_name(self) -> str:
        """The key."""
        return self._type_name

    @property
    def parent(self) -> Entity | None:
        """The element that contains this one."""
        return self._parent

    @property
    def children(self) -> list[frontend.Entity]:
        """The elements that this one contains: the items of the list, or of the attribute ``children``.

        Raises TypeError or ValueError without children, and RuntimeError for a child with several types.
        """
        self._children_read = True
        children = self._element
        if isinstance(children, dict):
            if "children" not in children:
                raise ValueError(
                    f"Expected entity `{self._type_name}` to have children entities. That can be a list of subentities "
                    "or a dictionary with a `children` list element"
                )
            self._read_names.add("children")
            children = children["children"]
        if not isinstance(children, list):
            raise TypeError(f"Expected a dict or list, got {type(children)}:\n---\n{children}\n---")
        if any(not isinstance(child, dict) or len(child) != 1 for child in children):
            raise RuntimeError("Subentities must be a dictionary with only one key, which is the entity type")
        return [Entity(element, name, parent=self) for child in children for name, element in child.items()]

    def assert_entity_completely_parsed(self) -> None:
        """Raise ValueError if an attribute or a child was not read."""
        if isinstance(self._element, list):
            if not self._children_read:
                raise ValueError(f"Unexpected nested entity(ies) found in `{self._type_name}`: {self._element}")
            return
        unread = set(self._element) - self._read_names
        if unread:
            raise ValueError(f"Unexpected key(s) found in `{self._type_name}`: {unread}")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute, which must be of `data_type` in YAML already; see `launch.frontend.Entity`."""
        if name not in self._element:
            if optional:
                return None
            raise AttributeError(f"Can not find attribute '{name}' in Entity '{self.type_name}'")
        self._read_names.add(name)
        value = self._element[name]
        expectation = f"Attribute '{name}' of Entity '{self.type_name}' expected to be"
        if check_is_list_entity(data_type):
            if isinstance(value, list) and value and isinstance(value[0], dict):
                return [Entity(child, name, parent=self) for child in value]
            raise TypeError(f"{expectation} a list of dictionaries.")
        if not is_instance_of(value, data_type, can_be_str=can_be_str):
            raise TypeError(f"{expectation} of type '{data_type}', got '{type(value)}'")
        return value
