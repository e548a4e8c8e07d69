"""A program in lockstep runs when it has something to do, and in each step where the host cannot see whether it has."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.e2e.sandbox_support import in_worker_sandbox
from tests.e2e.test_lockstep_features import open_lab, said, twice, write_workspace

STEPS = 10  # of 0.1 s

LISTENER = """
class Listener(Speaker):
    def __init__(self):
        super().__init__('listener')
        self.create_subscription(String, 'word', lambda message: self.say('heard', message.data), 10)
        {more}

{spin}
"""
SPIN = "spin(Listener)"


def listener(more: str, spin: str = SPIN) -> str:
    """Return a program whose node listens, and does something more."""
    return LISTENER.format(more=more.replace("\n", "\n        "), spin=spin)


QUIET = {  # each with how often it runs in `STEPS` steps after its first run, and what it says
    "nothing but a subscription": (listener("pass"), 0, []),
    "a slow timer": (listener("self.create_timer(0.4, lambda: self.say('tick'))"), 2, ["tick", "tick"]),
    "a cancelled timer": (
        listener("self.once = self.create_timer(0.1, lambda: (self.once.cancel(), self.say('once')))"),
        1,
        ["once"],
    ),
    "a wait with a time-out": (
        listener(
            "pass",
            """
def program():
    node = Listener()
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0.4)
        node.say('woke')
run(program)
""",
        ),
        2,
        ["woke", "woke"],
    ),
    "two executors by turns": (
        listener(
            "pass",
            """
def program():
    first, second = Listener(), Speaker('other')
    second.create_timer(0.3, lambda: second.say('tick'))
    while rclpy.ok():
        rclpy.spin_once(first, timeout_sec=0.2)
        rclpy.spin_once(second, timeout_sec=0.2)
run(program)
""",
        ),
        None,
        ["tick"] * 3,
    ),
}

THREADED = listener(
    "self.guard = self.create_guard_condition(lambda: self.say('guarded'))\n"
    "threading.Thread(target=self.work, daemon=True).start()",
    """
def work(self):
    machine = time.get_clock_info('monotonic')
    while True:
        self.guard.trigger()
        threading.Event().wait(0.001)
Listener.work = work
"""
    + SPIN,
)
UNSEEN = {
    "polling": listener(
        "pass",
        """
def program():
    node = Listener()
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
run(program)
""",
    ),
    "asyncio": listener(
        "pass",
        """
import asyncio
async def spin_in_a_loop():
    node = Listener()
    while rclpy.ok():
        rclpy.spin_once(node, timeout_sec=0)
        await asyncio.sleep(0)
run(lambda: asyncio.run(spin_in_a_loop()))
""",
    ),
    "a guard condition that a thread triggers": THREADED,
    "a guard condition that a timer triggers": listener(
        "self.guard = self.create_guard_condition(lambda: self.say('guarded'))\n"
        "self.create_timer(0.4, self.guard.trigger)"
    ),
    "a timer of the machine's time": listener(
        "self.create_timer(0.001, lambda: None, clock=Clock(clock_type=ClockType.STEADY_TIME))"
    ),
    "a timer of a clock that nobody steps": listener(
        "from rclpy.clock import ROSClock\nself.create_timer(0.001, lambda: None, clock=ROSClock())"
    ),
    "a child process": listener("import subprocess\nself.child = subprocess.Popen(['sleep', '60'])"),
    "an alarm": listener("import signal\nsignal.setitimer(signal.ITIMER_REAL, 600.0)"),
    "a coroutine that waits for the clock": listener(
        "self.once = self.create_timer(0.0001, self.work, callback_group=ReentrantCallbackGroup())",
        """
class Pause:
    def __await__(self):
        yield
async def work(self):
    self.once.cancel()
    while True:
        await Pause()
Listener.work = work
"""
        + SPIN,
    ),
    "jumps of the time": listener(
        "from rclpy.clock import JumpThreshold\n"
        "limit = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=None, on_clock_change=False)\n"
        "self.jumps = self.get_clock().create_jump_callback(limit, post_callback=lambda jump: None)"
    ),
    "the log's topic": listener(
        "from rcl_interfaces.msg import Log\nself.create_subscription(Log, '/rosout', lambda _: None, 10)"
    ),
    "an event of its publisher": listener(
        "from rclpy.event_handler import PublisherEventCallbacks\n"
        "events = PublisherEventCallbacks(matched=lambda _: None)\n"
        "self.watched = self.create_publisher(String, 'watched', 10, event_callbacks=events)"
    ),
}


def runs(scratch: Path, text: str) -> Any:
    """Return how often a program ran in each of `STEPS` steps, what it said in them, and what once it heard a word."""
    from std_msgs.msg import String

    workspace = write_workspace(scratch, node=text)
    with open_lab(workspace, "node", publishes={"/word": String}) as harness:
        harness.step(1_000_000)
        harness.until(lambda: True, 0.0)
        before, found = harness.activations["node"], []
        for _ in range(STEPS):
            harness.step(100_000_000)
            found.append(harness.activations["node"] - before)
            before = harness.activations["node"]
        first = [text.split()[1] for _, text in said(harness)]
        harness.publish("/word", String(data="late"))
        harness.step(100_000_000)
        return [found, first, [text.split()[1] for _, text in said(harness)][len(first) :]]


@pytest.mark.parametrize("name", QUIET)
def test_a_program_runs_when_it_has_something_to_do_and_not_otherwise(name: str) -> None:
    text, times, words = QUIET[name]
    found, first, then = in_worker_sandbox(runs, text)
    assert first == words
    assert "heard" in then
    assert times is None or sum(found) == times, found


@pytest.mark.parametrize("name", UNSEEN)
def test_a_program_that_may_be_moved_by_what_nobody_announces_runs_in_each_step(name: str) -> None:
    found, _, then = in_worker_sandbox(runs, UNSEEN[name])
    assert min(found) >= 1, found
    assert "heard" in then


TALKER = """
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.out = self.create_publisher(String, 'tick', 10)
        self.create_timer(0.1, lambda: self.out.publish(String(data='tick')))

spin(Talker)
"""
RECORDER = """
class Recorder(Node):
    def __init__(self):
        super().__init__('recorder')
        self.out, self.late = self.create_publisher(String, 'said', 100), None
        for topic in 'word', 'tick':
            self.create_subscription(String, topic, self.hear, 10)
        self.create_timer(0.1, lambda: self.say('timer'))

    def hear(self, message):
        self.say(message.data)
        if message.data == 'first':
            self.late = self.create_publisher(String, 'also', 10)

    def say(self, word):
        text = f'{word} {self.get_clock().now().nanoseconds - 100 * 10**9}'
        self.out.publish(String(data=text))
        if self.late is not None:
            self.late.publish(String(data=text))

spin(Recorder)
"""


def order(scratch: Path) -> Any:
    """Return what a recorder said of two steps, with a talker named before it and after it, and each one's runs."""
    from std_msgs.msg import String

    workspace = write_workspace(scratch, talker=TALKER, recorder=RECORDER)

    def run(*names: str) -> Any:
        subscribes = {"/also": String}
        with open_lab(workspace, *names, publishes={"/word": String}, subscribes=subscribes) as harness:
            harness.step(100_000_000)
            before = harness.activations.copy()
            for word in ("first", "second"):
                harness.publish("/word", String(data=word))
                harness.step(100_000_000)
            texts = [[text for _, text in said(harness, topic)] for topic in ("/said", "/also")]
            return [*texts, dict(harness.activations - before)]

    return [twice(lambda: run("talker", "recorder")), twice(lambda: run("recorder", "talker"))]


def test_messages_come_in_the_order_of_their_instants_and_of_the_programs_although_a_program_runs_once_a_step() -> None:
    after, before = in_worker_sandbox(order)
    assert after[0][2:] == [
        *("first 199999999", "timer 200000000", "tick 200000000"),
        *("second 299999999", "timer 300000000", "tick 300000000"),
    ]
    assert after[2]["talker"] == 2
    assert after[1] == after[0][3:], "a publisher that is made in a step is matched before it is used"
    assert before[0] == after[0]
