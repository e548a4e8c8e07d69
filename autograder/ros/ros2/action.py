"""`ros2 action`: list and send_goal."""

from __future__ import annotations

import argparse
import math
import signal
from typing import Any

from action_msgs.msg import GoalStatus
from rclpy.action import (
    ActionClient,
    get_action_names_and_types,
)

from autograder.ros.ros2 import graph
from autograder.ros.ros2.message_values import add_values_argument, make_message, read_values
from autograder.ros.ros2.parsing import ExitCode, Verb
from autograder.ros.ros2.session import Session, add_session_arguments, deferred_signals, open_session

_STATUS = {
    GoalStatus.STATUS_ACCEPTED: "ACCEPTED",
    GoalStatus.STATUS_EXECUTING: "EXECUTING",
    GoalStatus.STATUS_CANCELING: "CANCELING",
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}


def _list_arguments(parser: argparse.ArgumentParser) -> None:
    add_session_arguments(parser)
    parser.add_argument("-t", "--show-types", action="store_true", help="Additionally show the action type")
    parser.add_argument(
        "-c", "--count-actions", action="store_true", help="Only display the number of actions discovered"
    )


def _list(args: argparse.Namespace) -> ExitCode:
    with open_session(args) as session:
        session.settle()
        actions = sorted(get_action_names_and_types(session.node))
    if args.count_actions:
        print(len(actions))
        return None
    for name, types in actions:
        print(f"{name} [{', '.join(types)}]" if args.show_types else name)
    return None


def _send_goal_arguments(parser: argparse.ArgumentParser) -> None:
    parser.add_argument("action_name", help="Name of the ROS action (e.g. '/fibonacci')")
    parser.add_argument("action_type", help="Type of the ROS action (e.g. 'my_interfaces/action/Fibonacci')")
    add_values_argument(parser, "goal", "Goal request values in YAML format (e.g. '{order: 10}')")
    parser.add_argument("-f", "--feedback", action="store_true", help="Echo feedback messages for the goal")
    add_session_arguments(parser)


def _send_goal(args: argparse.Namespace) -> ExitCode:
    from rosidl_runtime_py import message_to_yaml

    action_class = graph.load_class(args.action_type, "action")
    goal, _ = make_message(action_class.Goal, read_values(args, "goal"), "message fields", allow_stamps=False)

    def on_feedback(message: Any) -> None:
        print(f"Feedback:\n    {message_to_yaml(message.feedback)}")

    with open_session(args) as session:
        client = ActionClient(session.node, action_class, args.action_name)
        print("Waiting for an action server to become available...")
        session.wait_for(client.server_is_ready, timeout=float("inf"))
        print(f"Sending goal:\n     {message_to_yaml(goal)}")
        goal_future = client.send_goal_async(goal, on_feedback if args.feedback else None)
        session.spin_until(goal_future)
        handle = goal_future.result()
        if not handle.accepted:
            print("Goal was rejected.")
            return None
        with deferred_signals() as interrupts:
            print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n")
            result_future = handle.get_result_async()
            session.wait_for(lambda: result_future.done() or bool(interrupts), math.inf)
            if interrupts:
                _cancel(session, handle)
        for number in interrupts[:1]:
            signal.raise_signal(number)
        response = result_future.result()
        print(f"Result:\n    {message_to_yaml(response.result)}")
        print(f"Goal finished with status: {_STATUS.get(response.status, 'UNKNOWN')}")
        client.destroy()
    return None


def _cancel(session: Session, handle: Any) -> None:
    """Ask the server to cancel the goal, so that the robot does not pursue it after Ctrl-C."""
    print("Canceling goal...")
    cancel_future = handle.cancel_goal_async()
    if session.spin_until(cancel_future, timeout=5.0) and cancel_future.result().goals_canceling:
        print("Goal canceled.")
    else:
        print("Failed to cancel goal")


VERBS = (
    Verb("list", "Output a list of action names", _list_arguments, _list),
    Verb("send_goal", "Send an action goal", _send_goal_arguments, _send_goal),
)
