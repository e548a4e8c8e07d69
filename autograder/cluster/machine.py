"""What a machine grades with. Only machines that agree in it give the same results, so only these work together.

A worker tells the scheduler its suites, lock, Python and tiers. For each pair of assignment and tier it also offers a
resource of Dask, whose name holds all four. A submission asks for one such resource, so the scheduler never gives it to
a worker that differs.
"""

from __future__ import annotations

import hashlib
import platform
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

from autograder import layout
from autograder.checks import suites
from autograder.sandbox import Tier
from autograder.sandbox.tiers import best_tier

LOCK = "requirements.lock"


@dataclass(frozen=True)
class Machine:
    """What a machine grades with.

    Attributes:
        suites: the version of each assignment's suite.
        lock: digest of the pinned packages.
        python: the version of Python, major and minor.
        tiers: the names of the tiers of isolation that it can give.
    """

    suites: Mapping[str, str]
    lock: str
    python: str
    tiers: tuple[str, ...]

    @classmethod
    def of_this(cls) -> Machine:
        """Describe this machine. It takes about a second."""
        tiers = [Tier.PROCESS, *({best_tier()} - {Tier.PROCESS})]
        return cls(
            {name: suites.hidden(name).version for name in suites.graded()},
            hashlib.sha256((layout.ROOT / LOCK).read_bytes()).hexdigest()[:12],
            ".".join(platform.python_version_tuple()[:2]),
            tuple(tier.value for tier in tiers),
        )

    @classmethod
    def from_json(cls, data: object) -> Machine | None:
        """Read what a worker told; None if it told nothing that can be read."""
        if not isinstance(data, dict) or set(data) != {"suites", "lock", "python", "tiers"}:
            return None
        told, tiers = data["suites"], data["tiers"]
        if not isinstance(told, dict) or not isinstance(tiers, (list, tuple)):
            return None
        return cls({str(k): str(v) for k, v in told.items()}, str(data["lock"]), str(data["python"]), tuple(tiers))

    def to_json(self) -> dict[str, Any]:
        """Return the JSON form."""
        return asdict(self)

    def resource(self, assignment: str, tier: Tier) -> str:
        """Return the name of the resource by which an assignment is graded in a tier."""
        return f"autograder {assignment} {self.suites.get(assignment)} {self.lock} {self.python} {tier.value}"

    def resources(self) -> list[str]:
        """Return the names of all resources that this machine offers."""
        return [self.resource(name, Tier(tier)) for name in self.suites for tier in self.tiers]

    def difference(self, other: Machine | None, assignment: str, tier: Tier) -> str:
        """Say in a sentence why another machine cannot grade for this one; empty if it can."""
        if other is None:
            return "it does not say what it grades with: start it with `--preload autograder.cluster`"
        pairs = (
            (f"its suite of {assignment} is", other.suites.get(assignment), self.suites.get(assignment)),
            (f"its {LOCK} is", other.lock, self.lock),
            ("its Python is", other.python, self.python),
        )
        for what, theirs, ours in pairs:
            if theirs != ours:
                return f"{what} {theirs or 'missing'}, and here it is {ours}: give both the same version of the course"
        if tier.value not in other.tiers:
            return f"it cannot isolate submissions by {tier.value}: `autograder doctor` there says what mends it"
        return ""
