"""The elements of XML launch files."""

from __future__ import annotations

from typing import Any
from xml.etree.ElementTree import Element

from launch import frontend
from launch.frontend.type_utils import check_is_list_entity
from launch.utilities.type_utils import get_typed_value


class Entity(frontend.Entity):
    """An XML element."""

    def __init__(self, xml_element: Element, *, parent: Entity | None = None) -> None:
        self._element = xml_element
        self._parent = parent
        self._read_attributes: set[str] = set()
        self._read_children: set[str] = set()

    @property
    def type_name(self) -> str:
        """The tag."""
        return self._element.tag

    @property
    def parent(self) -> Entity | None:
        """The element that contains this one."""
        return self._parent

    @property
    def children(self) -> list[frontend.Entity]:
        """The elements that this one contains."""
        self._read_children = {child.tag for child in self._element}
        return [Entity(child, parent=self) for child in self._element]

    def assert_entity_completely_parsed(self) -> None:
        """Raise ValueError if an attribute or a child was not read."""
        children = {child.tag for child in self._element} - self._read_children
        if children:
            raise ValueError(f"Unexpected nested tag(s) found in `{self.type_name}`: {children}")
        attributes = set(self._element.attrib) - self._read_attributes
        if attributes:
            raise ValueError(f"Unexpected attribute(s) found in `{self.type_name}`: {attributes}")

    def get_attr(self, name: str, *, data_type: Any = str, optional: bool = False, can_be_str: bool = True) -> Any:
        """Return an attribute, whose text is converted to `data_type`; see `launch.frontend.Entity`.

        An attribute ``name-sep`` is the separator of the items of a list.
        """
        if check_is_list_entity(data_type):
            children = [Entity(child, parent=self) for child in self._element if child.tag == name]
            if children:
                self._read_children.add(name)
                return children
        elif name in self._element.attrib:
            return self._convert_attribute(name, data_type, can_be_str)
        if optional:
            return None
        raise AttributeError(f"Attribute '{name}' of type '{data_type}' not found in Entity '{self.type_name}'")

    def _convert_attribute(self, name: str, data_type: Any, can_be_str: bool) -> Any:
        value: Any = self._element.attrib[name]
        self._read_attributes.add(name)
        separator = f"{name}-sep"
        if separator in self._element.attrib:
            self._read_attributes.add(separator)
            value = value.split(self._element.attrib[separator])
        try:
            return get_typed_value(value, data_type, can_be_str=can_be_str)
        except ValueError:
            raise TypeError(
                f"Attribute '{name}' of Entity '{self.type_name}' expected to be of type '{data_type}'."
                f"'{value}' can not be converted to one of those types"
            ) from None
