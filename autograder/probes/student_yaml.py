"""Reads untrusted YAML. The number of values to which aliases and merges expand is limited."""

from __future__ import annotations

from typing import Any

import yaml

MAX_VALUES = 20_000  # values in a file, with each alias counted as the values that it repeats


def load(text: str | bytes) -> Any:
    """Parse a YAML document into plain data.

    Raises:
        yaml.YAMLError: the text is not YAML, or a value contains itself or expands to more than `MAX_VALUES` values.
            PyYAML also raises other exceptions for tags and numbers that it cannot read.
    """
    loader = yaml.SafeLoader(text)
    try:
        node = loader.get_single_node()
        if node is None:
            return None
        _size(node, {})
        return loader.construct_document(node)
    finally:
        loader.dispose()


def _size(node: yaml.Node, sizes: dict[int, int]) -> int:
    """Return the number of values in a node. `sizes` maps other nodes to theirs, and nodes being counted to 0."""
    size = sizes.get(id(node))
    if size == 0:
        raise yaml.YAMLError("an alias is inside the value that it repeats")
    if size is None:
        sizes[id(node)] = 0
        items = node.value if isinstance(node, yaml.CollectionNode) else ()
        children = [child for item in items for child in (item if isinstance(item, tuple) else (item,))]
        size = sizes[id(node)] = 1 + sum(_size(child, sizes) for child in children)
    if size > MAX_VALUES:
        raise yaml.YAMLError(f"its aliases expand to more than {MAX_VALUES} values")
    return size
