"""Small student-like programs for the tests of lockstep, each with one feature of rclpy."""

from __future__ import annotations

HEAD = """
import threading, time
import rclpy
from rclpy.action import ActionClient, ActionServer, CancelResponse, GoalResponse
from rclpy.callback_groups import MutuallyExclusiveCallbackGroup, ReentrantCallbackGroup
from rclpy.clock import Clock, ClockType
from rclpy.duration import Duration
from rclpy.executors import ExternalShutdownException, MultiThreadedExecutor, SingleThreadedExecutor
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rcl_interfaces.msg import SetParametersResult
from std_msgs.msg import String
from std_srvs.srv import SetBool, Trigger

LATCHED = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)

class Speaker(Node):
    def __init__(self, name='speaker'):
        super().__init__(name)
        self.out = self.create_publisher(String, 'said', 100)

    def say(self, *words):
        now = self.get_clock().now().nanoseconds / 1e9 - 100
        self.out.publish(String(data=' '.join(map(str, (self.get_name(), *words, f'{now:.3f}')))))

def run(program):
    rclpy.init()
    try:
        program()
    except (KeyboardInterrupt, ExternalShutdownException):
        pass
    finally:
        rclpy.try_shutdown()

def spin(make, executor=None):
    def program():
        if executor is None:
            rclpy.spin(make())
        else:
            chosen = executor()
            chosen.add_node(node := make())
            chosen.spin()
    run(program)
"""

SERVER = """
class Server(Speaker):
    def __init__(self):
        super().__init__('server')
        self.calls = 0
        self.create_service(Trigger, 'ask', self.answer)
        self.declare_parameter('speed', 0.5)
        self.add_on_set_parameters_callback(self.check)

    def answer(self, request, response):
        self.calls += 1
        response.success, response.message = True, f'{self.calls}'
        self.say('asked')
        return response

    def check(self, parameters):
        fine = all(parameter.value <= 1.0 for parameter in parameters if parameter.name == 'speed')
        return SetParametersResult(successful=fine, reason='' if fine else 'too fast')

spin(Server)
"""

LATE_SERVER = """
class Server(Node):
    def __init__(self):
        super().__init__('server')
        self.calls = 0
        self.begins = self.create_timer(0.2, self.begin)

    def begin(self):
        self.begins.cancel()
        self.create_service(Trigger, 'ask', self.answer)

    def answer(self, request, response):
        self.calls += 1
        response.message = f'{self.calls}'
        return response

spin(Server)
"""

BUSY_SERVER = """
class Server(Node):
    def __init__(self):
        super().__init__('server')
        self.create_service(Trigger, 'ask', lambda request, response: response)
        self.create_timer(0.01, lambda: time.sleep(100.0))

spin(Server)
"""

ACTION_SERVER = """
from lockstep_interfaces.action import Count
class Counter(Speaker):
    def __init__(self):
        super().__init__('counter')
        self.action = ActionServer(node=self, action_type=Count, action_name='count',
                                   execute_callback=self.execute, goal_callback=self.check_goal,
                                   cancel_callback=lambda goal: CancelResponse.ACCEPT, callback_group={group}())

    def check_goal(self, goal):
        return GoalResponse.ACCEPT if goal.order < 50 else GoalResponse.REJECT

    {keyword} execute(self, goal):
        {before}
        counted = []
        for number in range(goal.request.order):
            if goal.is_cancel_requested:
                goal.canceled()
                self.say('cancelled after', number)
                return Count.Result(sequence=counted)
            counted.append(number)
            goal.publish_feedback(Count.Feedback(last=number))
            {pause}
        goal.succeed()
        self.say('done')
        return Count.Result(sequence=counted)

spin(Counter{executor})
"""

ACTION_SERVERS = {
    "a synchronous action": ACTION_SERVER.format(
        keyword="def", group="ReentrantCallbackGroup", before="", pause="time.sleep(0.2)", executor=""
    ),
    "an asynchronous action": ACTION_SERVER.format(
        keyword="async def", group="ReentrantCallbackGroup", before="", pause="", executor=""
    ),
    "an action at a rate, in many threads": ACTION_SERVER.format(
        keyword="def",
        group="ReentrantCallbackGroup",
        before="rate = self.create_rate(10)",
        pause="rate.sleep()",
        executor=", MultiThreadedExecutor",
    ),
    "an action by its clock, in many threads": ACTION_SERVER.format(
        keyword="def",
        group="ReentrantCallbackGroup",
        before="",
        pause="self.get_clock().sleep_for(Duration(seconds=0.1))",
        executor=", MultiThreadedExecutor",
    ),
}

ASKING = """
class Asking(Speaker):
    def __init__(self):
        super().__init__('asking')
        self.client = self.create_client(Trigger, 'ask'{group})
        self.client.wait_for_service()
        self.create_timer(0.5, self.tick)
{tick}
spin(Asking{executor})
"""

CLIENTS = {
    "done callbacks": ASKING.format(
        group="",
        executor="",
        tick="""
    def tick(self):
        future = self.client.call_async(Trigger.Request())
        future.add_done_callback(lambda future: self.say('got', future.result().message))
""",
    ),
    "await": ASKING.format(
        group=", callback_group=ReentrantCallbackGroup()",
        executor="",
        tick="""
    async def tick(self):
        for _ in range(2):
            self.say('got', (await self.client.call_async(Trigger.Request())).message)
""",
    ),
    "call in many threads": ASKING.format(
        group=", callback_group=MutuallyExclusiveCallbackGroup()",
        executor=", MultiThreadedExecutor",
        tick="""
    def tick(self):
        self.say('got', self.client.call(Trigger.Request()).message)
""",
    ),
    "an event in many threads": ASKING.format(
        group=", callback_group=ReentrantCallbackGroup()",
        executor=", MultiThreadedExecutor",
        tick="""
    def tick(self):
        done = threading.Event()
        future = self.client.call_async(Trigger.Request())
        future.add_done_callback(lambda future: done.set())
        done.wait()
        self.say('got', future.result().message)
""",
    ),
    "spin_until_future_complete": """
def program():
    node = Speaker('asking')
    client = node.create_client(Trigger, 'ask')
    client.wait_for_service()
    while rclpy.ok():
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future)
        node.say('got', future.result().message)
        end = node.get_clock().now().nanoseconds + 500_000_000
        while rclpy.ok() and node.get_clock().now().nanoseconds < end:
            rclpy.spin_once(node, timeout_sec=0.1)
run(program)
""",
}

WAITING_CLIENT = """
class Patient(Speaker):
    def __init__(self):
        super().__init__('patient')
        self.client = self.create_client(Trigger, 'ask')
        self.create_timer(0.1, self.tick)

    def tick(self):
        if not self.client.service_is_ready():
            return self.say('nobody')
        self.client.call_async(Trigger.Request()).add_done_callback(lambda f: self.say('got', f.result().message))

spin(Patient)
"""

CLIENT_WITH_TIMEOUT = """
def program():
    node = Speaker('asking')
    client = node.create_client(Trigger, 'ask')
    client.wait_for_service()
    node.create_timer(0.1, lambda: None)
    while rclpy.ok():
        future = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=0.35)
        node.say('answered' if future.done() else 'no answer')
run(program)
"""

TIMERS = """
class Timers(Speaker):
    def __init__(self):
        super().__init__('timers')
        self.slow = self.create_timer(0.4, self.tick)
        self.once = self.create_timer(0.3, self.shoot)
        self.late = None

    def tick(self):
        self.say('tick')
        if self.late is None:
            self.late = self.create_timer(0.05, lambda: self.say('late'))
            self.again = self.create_publisher(String, 'also', 10)
        else:
            self.late.cancel()
            self.once.reset()
            self.again.publish(String(data='tick'))

    def shoot(self):
        self.once.cancel()
        self.say('shot')

spin(Timers)
"""

WALL_CLOCK = """
from time import monotonic
class Wall(Speaker):
    def __init__(self):
        super().__init__('wall')
        self.began, self.stamp = monotonic(), time.time()
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.say(f'{monotonic() - self.began:.2f} {time.time() - self.stamp:.2f}')
        time.sleep(0.15)
        self.say('slept')

spin(Wall)
"""

OWN_CONTEXT = """
class Ticker(Node):
    def __init__(self, context):
        super().__init__('ticker', context=context)
        self.out = self.create_publisher(String, 'said', 100)
        self.create_timer(0.1, lambda: self.out.publish(String(data='tick')))

context = rclpy.Context()
context.init()
executor = SingleThreadedExecutor(context=context)
executor.add_node(Ticker(context))
while context.ok():
    executor.spin_once(timeout_sec=0.25)
"""

EVENTS_EXECUTOR = """
from rclpy.experimental import EventsExecutor

class Ticker(Speaker):
    def __init__(self):
        super().__init__('ticker')
        self.create_timer(0.1, lambda: self.out.publish(String(data='tick')))

rclpy.init()
executor = EventsExecutor()
executor.add_node(Ticker())
executor.spin()
"""

CLOCK_SLEEPS = """
class Sleeper(Speaker):
    def __init__(self):
        super().__init__('sleeper')
        self.once = self.create_timer(0.1, self.tick)

    def tick(self):
        self.once.cancel()
        for kind in ClockType.ROS_TIME, ClockType.STEADY_TIME:
            clock = self.get_clock() if kind == ClockType.ROS_TIME else Clock(clock_type=kind)
            self.say(clock.sleep_for(rel_time=Duration(seconds=0.25)))
            self.say(clock.sleep_until(until=clock.now() + Duration(seconds=0.25), context=None))
        try:
            self.get_clock().sleep_until(clock.now())
        except ValueError as error:
            self.say(error)

spin(Sleeper)
"""

TWO_NODES = """
class Asker(Speaker):
    def __init__(self):
        super().__init__('asker')
        self.questions = self.create_publisher(String, 'question', 10)
        self.create_subscription(String, 'reply', lambda message: self.say('heard', message.data), 10)
        self.client = self.create_client(Trigger, 'ask')
        self.create_timer(0.1, self.tick)

    def tick(self):
        self.questions.publish(String(data='why'))
        self.client.call_async(Trigger.Request()).add_done_callback(lambda f: self.say('got', f.result().message))

class Replier(Node):
    def __init__(self):
        super().__init__('replier')
        self.count = 0
        self.replies = self.create_publisher(String, 'reply', 10)
        self.create_subscription(String, 'question', self.reply, 10)
        self.create_service(Trigger, 'ask', self.answer)

    def reply(self, message):
        for number in range(3):
            self.replies.publish(String(data=f'{message.data} {number}'))

    def answer(self, request, response):
        self.count += 1
        response.message = str(self.count)
        return response

def program():
    executor = SingleThreadedExecutor()
    executor.add_node(asker := Asker())
    executor.add_node(replier := Replier())
    executor.spin()
run(program)
"""

MAP = """
class Map(Node):
    def __init__(self):
        super().__init__('map')
        publisher = self.create_publisher(String, 'map', LATCHED)
        publisher.publish(String(data='old map'))
        publisher.publish(String(data='map'))
        self.map = publisher

spin(Map)
"""

MAP_READER = """
class Reader(Speaker):
    def __init__(self):
        super().__init__('reader')
        self.create_subscription(String, 'map', lambda message: self.say('read', message.data), LATCHED)

spin(Reader)
"""

PINGER = """
class Pinger(Speaker):
    def __init__(self):
        super().__init__('pinger')
        self.balls = self.create_publisher(String, 'ping', 10)
        self.create_subscription(String, 'pong', self.hit, 10)
        self.create_timer(0.1, lambda: self.balls.publish(String(data='5')))

    def hit(self, message):
        self.say('hit', message.data)
        if int(message.data):
            self.balls.publish(message)

spin(Pinger)
"""

PONGER = """
class Ponger(Speaker):
    def __init__(self):
        super().__init__('ponger')
        self.balls = self.create_publisher(String, 'pong', 10)
        self.create_subscription(String, 'ping', lambda m: self.balls.publish(String(data=str({next}))), {qos})

spin(Ponger)
"""

CUSTOM_TYPE_SPEAKER = """
from lockstep_interfaces.msg import Word
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.words = self.create_publisher(Word, 'words', 10)
        self.create_timer(0.1, lambda: self.words.publish(Word(text='hello')))
spin(Talker)
"""

# Publishes invalid bytes among valid messages: too few, wrong byte order, too many, and with a false length.
FORGED_WORDS = """
from lockstep_interfaces.msg import Word
HEADER = bytes([0, 1, 0, 0])
FORGED = [HEADER, HEADER + b'ab', bytes(4) + bytes([0, 0, 0, 2]) + b'a' + bytes(1)]
FORGED += [HEADER + bytes([255] * 4) + b'a', HEADER + bytes([0, 0, 8, 0]) + bytes(512 * 1024)]
class Talker(Node):
    def __init__(self):
        super().__init__('talker')
        self.words = self.create_publisher(Word, 'words', 100)
        self.create_timer(0.1, self.talk)

    def talk(self):
        for forged in FORGED:
            self.words.publish(forged)
            self.words.publish(Word(text='hello'))
spin(Talker)
"""

CUSTOM_TYPE_LISTENER = """
from lockstep_interfaces.msg import Word
class Listener(Speaker):
    def __init__(self):
        super().__init__('listener')
        self.create_subscription(Word, 'words', lambda message: self.say(message.text), 10)
spin(Listener)
"""

DEADLOCKS = {
    "the only thread": (CLIENTS["call in many threads"].replace(", MultiThreadedExecutor", ""), "the only thread"),
    "the group": (
        CLIENTS["call in many threads"].replace(", callback_group=MutuallyExclusiveCallbackGroup()", ""),
        "is in a callback group that the waiting callback holds",
    ),
    "before any spin": (
        "def program():\n    node = Speaker()\n    client = node.create_client(Trigger, 'ask')\n"
        "    client.wait_for_service()\n    client.call(Trigger.Request())\nrun(program)\n",
        "nothing spins yet",
    ),
    "a spin in a callback": (
        CLIENTS["done callbacks"].replace(
            "future.add_done_callback(lambda future: self.say('got', future.result().message))",
            "rclpy.spin_until_future_complete(self, future)",
        ),
        "waits for ever in spin_until_future_complete() for an answer from /ask",
    ),
    "await": (
        CLIENTS["await"].replace(", callback_group=ReentrantCallbackGroup()", ""),
        "waits for ever in await client.call_async() for an answer from /ask",
    ),
    "a rate": (
        "class Rated(Speaker):\n    def __init__(self):\n        super().__init__()\n"
        "        self.create_timer(0.1, lambda: self.rate.sleep())\n        self.rate = self.create_rate(10)\n"
        "spin(Rated)\n",
        "waits for ever in rate.sleep()",
    ),
}

UNSTEPPABLE = {
    "thread": """
def program():
    node = Speaker()
    threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
    rate = node.create_rate(10)
    while rclpy.ok():
        node.say('tick')
        rate.sleep()
run(program)
""",
    "clock": """
class Steady(Speaker):
    def __init__(self):
        super().__init__()
        self.create_timer(0.1, lambda: self.say('tick'), clock=Clock(clock_type=ClockType.STEADY_TIME))
spin(Steady)
""",
    "sleep": """
def program():
    node = Speaker()
    while rclpy.ok():
        node.say('tick')
        time.sleep(0.1)
run(program)
""",
}

FLOODS = {
    "3,000 topics": """
class Flood(Node):
    def __init__(self):
        super().__init__('flood')
        self.topics = [self.create_publisher(String, f'/topic_{number}', 10) for number in range(3000)]


rclpy.init()
rclpy.spin(Flood())
""",
    "100 kHz": """
class Flood(Node):
    def __init__(self):
        super().__init__('flood')
        self.said = self.create_publisher(String, '/said', 10)
        self.create_timer(0.00001, lambda: self.said.publish(String(data='x')))


rclpy.init()
rclpy.spin(Flood())
""",
    "100,000 at once": """
class Flood(Node):
    def __init__(self):
        super().__init__('flood')
        self.said = self.create_publisher(String, '/said', 10)
        self.create_timer(0.4, self.flood)

    def flood(self):
        for _ in range(100_000):
            self.said.publish(String(data='x'))


rclpy.init()
rclpy.spin(Flood())
""",
    "the grader's parameters": """
from rcl_interfaces.srv import SetParameters


class Flood(Node):
    def __init__(self):
        super().__init__('flood')
        self.said = self.create_publisher(String, '/said', 10)
        self.grader = self.create_client(SetParameters, '/grader/set_parameters')
        self.create_timer(0.1, self.ask)

    def ask(self):
        self.said.publish(String(data=f'ready: {self.grader.service_is_ready()}'))


rclpy.init()
rclpy.spin(Flood())
""",
}
