"""A result without its times, to compare two gradings of a submission."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any


def without_times(result: Mapping[str, Any]) -> dict[str, Any]:
    """Return a result, as its file has it, without the times of its grading."""
    kept = copy.deepcopy(dict(result))
    for timed in filter(None, (kept, kept["build"], *kept["checks"])):
        del timed["seconds"]
    for field in ("started", "phases", "held_up"):
        del kept[field]
    return kept
