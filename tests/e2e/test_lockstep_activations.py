"""A program in lockstep runs only when it has something to do, or in each step if the host cannot know that."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from tests.e2e.sandbox_support import in_worker_sandbox
from tests.e2e.test_lockstep_features import open_harness, received, same_result_twice, write_workspace

STEPS = 10  # of 0.1 s each

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
    """Return a program whose node has a subscription and runs `more` in its constructor."""
    return LISTENER.format(more=more.replace("\n", "\n        "), spin=spin)


PREDICTABLE = {  # each with the number of runs in `STEPS` steps after the first one, and the published words
    "only a subscription": (listener("pass"), 0, []),
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
    "two executors in turn": (
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
UNPREDICTABLE = {
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
    "a timer of the steady clock": listener(
        "self.create_timer(0.001, lambda: None, clock=Clock(clock_type=ClockType.STEADY_TIME))"
    ),
    "a timer of a clock that is not stepped": listener(
        "from rclpy.clock import ROSClock\nself.create_timer(0.001, lambda: None, clock=ROSClock())"
    ),
    "a child process": listener("import subprocess\nself.child = subprocess.Popen(['sleep', '60'])"),
    "an alarm": listener("import signal\nsignal.setitimer(signal.ITIMER_REAL, 600.0)"),
    "a coroutine that yields": listener(
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
    "a callback for time jumps": listener(
        "from rclpy.clock import JumpThreshold\n"
        "limit = JumpThreshold(min_forward=Duration(nanoseconds=1), min_backward=None, on_clock_change=False)\n"
        "self.jumps = self.get_clock().create_jump_callback(limit, post_callback=lambda jump: None)"
    ),
    "a subscription to /rosout": listener(
        "from rcl_interfaces.msg import Log\nself.create_subscription(Log, '/rosout', lambda _: None, 10)"
    ),
    "an event of a publisher": listener(
        "from rclpy.event_handler import PublisherEventCallbacks\n"
        "events = PublisherEventCallbacks(matched=lambda _: None)\n"
        "self.watched = self.create_publisher(String, 'watched', 10, event_callbacks=events)"
    ),
}


def activations(scratch: Path, text: str) -> Any:
    """Return how often a program ran in each of `STEPS` steps, its words in them, and its words after a message."""
    from std_msgs.msg import String

    workspace = write_workspace(scratch, node=text)
    with open_harness(workspace, "node", publishes={"/word": String}) as harness:
        harness.step(1_000_000)
        harness.until(lambda: True, 0.0)
        before, counts = harness.activations["node"], []
        for _ in range(STEPS):
            harness.step(100_000_000)
            counts.append(harness.activations["node"] - before)
            before = harness.activations["node"]
        first = [text.split()[1] for _, text in received(harness)]
        harness.publish("/word", String(data="late"))
        harness.step(100_000_000)
        return [counts, first, [text.split()[1] for _, text in received(harness)][len(first) :]]


@pytest.mark.parametrize("name", PREDICTABLE)
def test_a_program_runs_only_when_it_has_something_to_do(name: str) -> None:
    text, runs, words = PREDICTABLE[name]
    counts, first, after_message = in_worker_sandbox(activations, text)
    assert first == words
    assert "heard" in after_message
    assert runs is None or sum(counts) == runs, counts


@pytest.mark.parametrize("name", UNPREDICTABLE)
def test_a_program_with_unpredictable_events_runs_in_each_step(name: str) -> None:
    counts, _, after_message = in_worker_sandbox(activations, UNPREDICTABLE[name])
    assert min(counts) >= 1, counts
    assert "heard" in after_message


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


def record_in_both_orders(scratch: Path) -> Any:
    """Return a recorder's messages in two steps and each program's runs, with the recorder listed last and first."""
    from std_msgs.msg import String

    workspace = write_workspace(scratch, talker=TALKER, recorder=RECORDER)

    def run(*names: str) -> Any:
        subscribes = {"/also": String}
        with open_harness(workspace, *names, publishes={"/word": String}, subscribes=subscribes) as harness:
            harness.step(100_000_000)
            before = harness.activations.copy()
            for word in ("first", "second"):
                harness.publish("/word", String(data=word))
                harness.step(100_000_000)
            texts = [[text for _, text in received(harness, topic)] for topic in ("/said", "/also")]
            return [*texts, dict(harness.activations - before)]

    return [same_result_twice(lambda: run("talker", "recorder")), same_result_twice(lambda: run("recorder", "talker"))]


def test_messages_have_the_same_order_whichever_program_is_listed_first() -> None:
    listed_last, listed_first = in_worker_sandbox(record_in_both_orders)
    assert listed_last[0][2:] == [
        *("first 199999999", "timer 200000000", "tick 200000000"),
        *("second 299999999", "timer 300000000", "tick 300000000"),
    ]
    assert listed_last[2]["talker"] == 2
    assert listed_last[1] == listed_last[0][3:], "a publisher that is created in a step is matched before it is used"
    assert listed_first[0] == listed_last[0]
