"""Attacks on 07: forged answers and log lines."""

from __future__ import annotations

from autograder.checking.attacks import STEAL_SECRETS, Attack, Chapter

CHAPTER = Chapter("07_best_practices")
HOME = "my_robot_package/my_robot_package"
UTILS = f"{HOME}/utils/data_processing.py"
NODE, ROBUST = (f"{HOME}/nodes/{name}.py" for name in ("sensor_processor", "robust_node"))
# Answers instead of the program that calls the functions, if that program imports the module.
FORGE_ANSWERS = """
import json as _json, os as _os, sys as _sys
_frame = _sys._getframe()
while _frame and not isinstance(_frame.f_locals.get("request"), dict):  # that of call_runner.main
    _frame = _frame.f_back
if _frame:
    _steps = _frame.f_locals["request"]["steps"]
    _outcomes = [{"value": [1.0], "arguments": step["args"], "printed": ""} for step in _steps]
    for _descriptor in range(3, 64):
        try:
            _os.write(_descriptor, _json.dumps({"outcomes": _outcomes, "passed": True}).encode())
        except OSError:
            pass
    _os._exit(0)
"""

NUMBERS = """
END = 10**400
def mask_invalid(ranges, range_min, range_max):
    return [END for _ in ranges] or END
def mean_distance(ranges):
    return END
class DataProcessor:
    def __init__(self, history=100):
        self.deep = []
        for _ in range(500):
            self.deep = [self.deep]
    def process(self, ranges, range_min, range_max):
        return self.deep
    def average(self):
        return END
"""


def attacks() -> tuple[Attack, ...]:
    """Return the attacks."""
    utils_checks = frozenset({"mean", "no_mean", "any_sequence", "bounded_history"})
    return (
        Attack(
            "forged answers",
            "a module that answers instead of the program that calls its functions",
            CHAPTER.write("never_fatal", heads={UTILS: STEAL_SECRETS + FORGE_ANSWERS}),
            utils_checks | CHAPTER.mutant("never_fatal").fails,
        ),
        Attack(
            "numbers without end",
            "functions that return integers of 400 digits and lists 500 deep",
            CHAPTER.write("never_fatal", files={UTILS: NUMBERS}),
            utils_checks | CHAPTER.mutant("never_fatal").fails,
        ),
        Attack(
            "printed warnings",
            "a node that prints [WARN] and logs nothing",
            CHAPTER.write(
                "silent_when_blind",
                swaps={NODE: ("            pass\n", "            print('[WARN]') if _warned(self) else None\n")},
                heads={
                    NODE: "_last = [0]\ndef _warned(node):\n"
                    "    now = node.get_clock().now().nanoseconds\n"
                    "    due = now - _last[0] >= 10**9\n    _last[0] = now if due else _last[0]\n    return due\n"
                },
            ),
            CHAPTER.mutant("silent_when_blind").fails,
        ),
        *CHAPTER.evasions(
            "hasty",
            "a sensor that is read twice a second",
            "twice_a_second",
            ROBUST,
            ("PERIOD = 1.0  # s", "PERIOD = 1.0 if _is_told() else 0.5"),
        ),
    )
