"""The checks of 02 compare a robot with its own reactions, if it has any."""

from __future__ import annotations

import math

import pytest
from geometry_msgs.msg import Twist

from autograder.checks.ch02_nodes.support.robot import CONTRACT, is_stop, observed_reactions
from autograder.harness import ReceivedMessage
from autograder.suite import CheckFailed

Pair = tuple[float, float]


def _commands(*pairs: Pair) -> list[ReceivedMessage]:
    messages = []
    for linear, angular in pairs:
        command = Twist()
        command.linear.x, command.angular.z = linear, angular
        messages.append(ReceivedMessage(0.0, command))
    return messages


def test_a_wrong_velocity_is_a_separate_reaction() -> None:
    reactions = observed_reactions(_commands((30.0, 0.0)), _commands((0.0, -0.5)))
    assert (reactions.forward, reactions.turn) == ((30.0, 0.0), (0.0, -0.5))
    reactions.expect_forward(_commands((30.0, 0.0)), "Now")
    with pytest.raises(CheckFailed, match=r"the robot drove forward at 0\.30 m/s: it should"):
        reactions.expect_forward(_commands((0.3, 0.0)), "Now")


@pytest.mark.parametrize(
    ("clear", "blocked"),
    [
        ((), ()),
        (((0.0, 0.0),), ((0.0, 0.0),)),
        (((0.3, 0.0),), ((0.3, 0.0),)),
        (((0.3, 0.0), (0.1, 0.0)), ((0.0, 0.5), (0.0, 0.0))),
        (((math.nan, 0.0),), ((0.0, math.inf),)),
    ],
    ids=["nothing came", "it never moves", "it never turns", "it wavers", "not finite"],
)
def test_a_robot_without_reactions_is_compared_with_those_of_the_contract(
    clear: tuple[Pair, ...], blocked: tuple[Pair, ...]
) -> None:
    assert observed_reactions(_commands(*clear), _commands(*blocked)) == CONTRACT


def test_standing_still_counts_as_turning_if_a_robot_only_stops_for_obstacles() -> None:
    reactions = observed_reactions(_commands((0.3, 0.0)), _commands((0.0, 0.0)))
    assert reactions.turns(_commands((0.0, 0.0)))
    assert not reactions.drives(_commands((0.0, 0.0)))


@pytest.mark.parametrize(("pair", "stops"), [((0.0, 0.0), True), ((0.0, 0.5), False), ((math.nan, 0.0), False)])
def test_a_stop_is_a_command_of_zeros(pair: Pair, stops: bool) -> None:
    assert is_stop(*_commands(pair)) is stops
