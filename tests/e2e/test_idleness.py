"""A program in lockstep skips the instants at which it has nothing to do, and says the same as if it did not."""

from __future__ import annotations

from functools import lru_cache
from pathlib import Path
from typing import Any

import pytest

from tests.e2e.cell_support import in_cell
from tests.e2e.test_lockstep import HEAD, PROGRAMS, SPIN

STEPS, STEP_NS = 200, 10_000_000
EVERY = 17  # steps between two messages to the program


def derived(name: str, body: str) -> str:
    """Return a program whose node is `Echo` with more to it."""
    return f"class {name}(Echo):\n{body}\nrun(lambda: rclpy.spin({name}()))\n"


MORE = {
    "a slow timer": SPIN.format(node="Echo(period=0.5)"),
    "a timer that ends, and begins again when something is heard": derived(
        "Once",
        """
    def tick(self):
        super().tick()
        for timer in self.timers:
            timer.cancel()

    def hear(self, message):
        super().hear(message)
        for timer in self.timers:
            timer.reset()
""",
    ),
    "a timer whose period changes": derived(
        "Slower",
        """
    def tick(self):
        super().tick()
        for timer in self.timers:
            timer.timer_period_ns += 30_000_000
""",
    ),
    "a timer made by a callback": derived(
        "Maker",
        """
    def hear(self, message):
        super().hear(message)
        timer = self.create_timer(0.035, lambda: (timer.cancel(), self.say('late')))
""",
    ),
    "a guard condition": derived(
        "Guard",
        """
    def __init__(self):
        super().__init__(period=0.25)
        self.guard = self.create_guard_condition(lambda: self.say('guard'))

    def tick(self):
        super().tick()
        self.guard.trigger()
""",
    ),
    "a coroutine": derived(
        "Waiting",
        """
    def __init__(self):
        self.wanted = rclpy.task.Future()
        super().__init__(period=0.25)

    def create_timer(self, *arguments):
        group = rclpy.callback_groups.MutuallyExclusiveCallbackGroup()
        return super().create_timer(*arguments, callback_group=group)

    async def hear(self, message):
        await self.wanted
        self.say('waited')

    def tick(self):
        super().tick()
        wanted, self.wanted = self.wanted, rclpy.task.Future()
        wanted.set_result(None)
""",
    ),
    "a sleep in a callback": derived(
        "Sleepy",
        """
    def hear(self, message):
        import time
        time.sleep(0.073)
        super().hear(message)
""",
    ),
    "a loop that looks again and again": """
def program():
    node = Echo(period=0.5)
    loops = 0
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
        loops += 1
        if loops % 30 == 0:
            node.say(f'loop {loops}')
run(program)
""",
    "a loop that waits": """
def program():
    node = Echo(period=0.5)
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.13)
        node.say('looked')
run(program)
""",
    "nothing but a subscription": derived(
        "Deaf",
        """
    def create_timer(self, *arguments, **options):
        pass
""",
    ),
}


def turns(scratch: Path, program: str) -> dict[str, Any]:
    """Run a program twice, at first with all its turns; return what it said and the number of its turns in both."""
    from std_msgs.msg import String

    from autograder.harness import SteppedHarness, Workspace
    from autograder.lockstep import Stepper
    from autograder.ros import activate

    install = scratch / "ws" / "install" / "pkg" / "lib" / "pkg"
    install.mkdir(parents=True)
    (install / "node").write_text(f"#!/usr/bin/env python3\n{HEAD}{program}")
    (scratch / "home").mkdir()
    workspace = Workspace(scratch / "ws", activate(), scratch / "home")
    took, plain = [0], Stepper.step

    def step(stepper: Stepper, *arguments: Any) -> Any:
        took[0] += 1
        return plain(stepper, *arguments)

    Stepper.step = step  # type: ignore[method-assign]
    found: dict[str, Any] = {}
    for way in ("all", "needed"):
        if way == "all":
            sparing, SteppedHarness._let_run = SteppedHarness._let_run, SteppedHarness._step_program  # type: ignore[method-assign]
        else:
            SteppedHarness._let_run = sparing  # type: ignore[method-assign]
        took[0] = 0
        with SteppedHarness(workspace, "pkg", "node", offers={"/heard": String}, listens={"/said": String}) as harness:
            for number in range(STEPS):
                if number % EVERY == 0:
                    harness.publish("/heard", String(data=f"message {number}"))
                harness.step(STEP_NS)
            notes = harness.notes
        said = [(round(stamped.seconds, 3), stamped.message.data) for stamped in harness.messages("/said")]
        found[way] = [said, notes, took[0]]
    return found


@lru_cache
def both_ways(name: str) -> Any:
    """Return what `turns` finds out about a program."""
    return in_cell(turns, {**PROGRAMS, **MORE}[name])


@pytest.mark.parametrize("name", [*MORE, "two nodes in one executor", "many threads", "two nodes by turns"])
def test_leaving_out_what_is_idle_changes_nothing(name: str) -> None:
    found = both_ways(name)
    (said, notes, turned), (said_idly, notes_idly, turned_idly) = found["all"], found["needed"]
    assert len(said) >= STEPS // EVERY
    assert (said_idly, notes_idly) == (said, notes)
    assert turned_idly <= turned


@pytest.mark.parametrize(("name", "most"), [("a slow timer", 30), ("nothing but a subscription", 20)])
def test_a_program_lives_through_few_instants_when_it_has_little_to_do(name: str, most: int) -> None:
    found = both_ways(name)
    assert found["all"][2] >= STEPS
    assert found["needed"][2] <= most
