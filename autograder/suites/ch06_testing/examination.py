"""All runs of one student's tests: first on a right version, then on many, right and faulty, in a drawn order.

Right versions and faulty ones are mixed and run alike, so that neither the time nor the circumstances of a run tell
which it has. What does not pass on the first right version meets no other.
"""

from __future__ import annotations

import random
from collections.abc import Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cached_property
from typing import Any

from autograder.checks import CheckFailed, expect
from autograder.lab import Workspace
from autograder.probes import testing
from autograder.probes.colcon import colcon_test
from autograder.probes.testing import Order, Report, Source
from autograder.sandbox import Ending
from autograder.suites.ch06_testing.faults import STYLES, Fault, broken, faults, right
from autograder.visible.ch06_testing.contract import GUARD, LAUNCH, LEAST, LIMITS, PACKAGE
from autograder.visible.ch06_testing.verdicts import fit, trouble

FILES = {
    **dict.fromkeys(("stop", "slow", "clear", "infinity", "unknown", "back", "chosen", "refused"), LIMITS),
    **dict.fromkeys(("name", "first_distance", "newest", "turn", "one_answer"), GUARD),
    **dict.fromkeys(("parameters", "sensor_qos", "stale", "watchdog"), GUARD),
    **dict.fromkeys(("configuration", "runs"), LAUNCH),
}
INTRUDER = {
    "cmd_vel": "geometry_msgs/msg/Twist",
    "cmd_vel_raw": "geometry_msgs/msg/Twist",
    "distance": "sensor_msgs/msg/Range",
}
SECOND, HARD, BACKWARDS, DISTURBED = "second", "hard", "backwards", "disturbed"
# All at once that good tests bear. Such a run has a right version for sure; the one in other words is not told apart.
HARDER: dict[str, dict[str, Any]] = {LIMITS: {"backwards": True}, GUARD: {"backwards": True, "intruder": INTRUDER}}


class Examination:
    """The runs of a submission's tests; each is made when it is first asked for, once."""

    def __init__(self, workspace: Workspace, seed: int) -> None:
        self._workspace = workspace
        self._draw = random.Random(f"{seed}:versions")

    @cached_property
    def source(self) -> Source:
        """The student's package, read once: later, `colcon test` lets its code write there."""
        return testing.take(self._workspace, PACKAGE)

    @cached_property
    def trial(self) -> dict[str, Report]:
        """What the tests of each file say of a right version."""
        there = [name for name in LEAST if name in self.source.tests]
        return dict(zip(there, self._run([self._right(name, STYLES[0]) for name in there]), strict=True))

    @cached_property
    def runs(self) -> dict[tuple[str, str], Report]:
        """The other runs: by file, and what is special about the version or the run."""
        keys: list[tuple[str, str]] = []
        orders: dict[tuple[str, str], Order] = {}
        # What takes long comes first. Which file it is, a test knows anyway.
        for name in (name for name in reversed(LEAST) if fit(name, self.trial.get(name))):
            orders[name, SECOND] = self._right(name, STYLES[1])
            if name in HARDER:
                orders[name, HARD] = self._right(name, STYLES[0], **HARDER[name])
            for fault in faults():
                if FILES[fault.check] == name:
                    version = broken(fault, self._draw.choice(STYLES), self._draw)
                    orders[name, fault.id] = Order((name,), version, first_failure=True)
            mine = [key for key in orders if key[0] == name]
            self._draw.shuffle(mine)
            keys += mine
        with ThreadPoolExecutor(1) as beside:  # colcon waits most of its time, too
            beside.submit(lambda: self.colcon)
            return dict(zip(keys, self._run([orders[key] for key in keys]), strict=True))

    @cached_property
    def colcon(self) -> Report:
        """What `colcon test` does with the student's own package."""
        return colcon_test(self._workspace, PACKAGE)

    def expect_right(self, name: str, *whats: str) -> None:
        """Fail the check unless a file's tests pass on the right version in other words, backwards, or disturbed."""
        for what in whats:
            hard = self.runs.get((name, HARD))
            if what != SECOND and (hard is None or hard.passed):
                continue
            report = self.runs[name, SECOND] if what == SECOND else self._alone[name, what]
            if not report.passed:
                raise CheckFailed(trouble(name, report, _WHERE[what]))

    def expect_objection(self, check: str, promise: str) -> None:
        """Fail the check unless the tests of its file object to every fault that belongs to it.

        A run that has to be stopped objects, too; that it does not end by itself is another check's matter.
        """
        name = FILES[check]
        mine = [fault for fault in faults() if fault.check == check]
        found = [fault for fault in mine if self._objects(name, fault)]
        expect(
            len(found) == len(mine),
            f"{len(mine) - len(found)} of {len(mine)} faulty versions that break this line of the contract "
            f"pass all tests in {name}: {promise}",
            fraction=len(found) / len(mine) if len(found) < len(mine) else 0.0,
        )

    def endless(self) -> list[str]:
        """Return the files whose tests had to be stopped on a faulty version."""
        ids = {fault.id for fault in faults()}
        return sorted({n for (n, what), r in self.runs.items() if what in ids and r.ending is Ending.WALL_TIME})

    def _objects(self, name: str, fault: Fault) -> bool:
        report = self.runs[name, fault.id]
        return report.ending is Ending.WALL_TIME or report.objects(self.trial[name])

    @cached_property
    def _alone(self) -> dict[tuple[str, str], Report]:
        """Each difficulty by itself, for the files that did not bear all at once."""
        orders: dict[tuple[str, str], Order] = {}
        for name in (name for name, what in self.runs if what == HARD and not self.runs[name, what].passed):
            orders[name, BACKWARDS] = self._right(name, STYLES[0], backwards=True)
            orders[name, DISTURBED] = self._right(name, STYLES[0], intruder=INTRUDER)
        return dict(zip(orders, self._run(list(orders.values())), strict=True))

    def _right(self, name: str, style: str, **more: Any) -> Order:
        return Order((name,), right(style, self._draw), first_failure=True, **more)

    def _run(self, orders: Sequence[Order]) -> list[Report]:
        return testing.run(self._workspace, self.source, orders)


# What a test says of these versions stays here: only the first version's text is public.
_WHERE = {
    SECOND: "on a right speed_guard that is written differently: test the contract, no attributes and no inner names",
    BACKWARDS: "when they run in the opposite order: one test lives on what another has left behind",
    DISTURBED: "while another robot publishes the same topics in the default domain: give the context a domain_id",
}
