"""The numbers of transitions and states are those of lifecycle_msgs."""

from __future__ import annotations

from launch_ros.actions import LifecycleTransition
from launch_ros.events.lifecycle import ChangeState
from lifecycle_msgs.msg import State, Transition


def test_the_transitions_are_those_of_the_message() -> None:
    for number, name in ChangeState.valid_transitions.items():
        assert getattr(Transition, name) == number
    assert set(LifecycleTransition.transition_targets) == set(ChangeState.valid_transitions) - {
        Transition.TRANSITION_CREATE,
        Transition.TRANSITION_DESTROY,
    }


def test_the_states_are_those_of_the_message() -> None:
    constants = {name for name in dir(State) if name.startswith(("PRIMARY_STATE_", "TRANSITION_STATE_"))}
    assert {name: getattr(State, name) for name in constants} == {
        name: number for number, name in ChangeState.valid_states.items()
    }
