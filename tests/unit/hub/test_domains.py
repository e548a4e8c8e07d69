"""No two users of a hub are in one ROS domain: above what there is, a server is refused with a sentence."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from autograder.lms.hub.spawner import CourseSpawner, NoDomainLeftError
from autograder.ros.domains import DOMAINS


@pytest.fixture
def spawners() -> Iterator[list[CourseSpawner]]:
    """A list for spawners; in the end their servers are stopped."""
    made: list[CourseSpawner] = []
    yield made
    for spawner in made:
        spawner.clear_state()


def domain_of(spawner: CourseSpawner) -> int:
    return int(spawner.get_state()["ros_domain"])


def start_until_refused(spawners: list[CourseSpawner]) -> None:
    """Let one user after the other start a server, as far as domains go, until one is refused."""
    while True:
        spawners.append(CourseSpawner())
        spawners[-1].claim_domain()


def test_each_of_many_users_has_a_domain_and_the_next_one_is_told_why_there_is_none(
    spawners: list[CourseSpawner],
) -> None:
    with pytest.raises(NoDomainLeftError, match="A server that is stopped gives its domain back") as refused:
        start_until_refused(spawners)
    assert refused.value.jupyterhub_message == str(refused.value)  # what the hub shows
    with_domain = spawners[:-1]
    assert len({domain_of(spawner) for spawner in with_domain}) == len(with_domain) <= len(DOMAINS)
    assert len(with_domain) > 1


def test_a_server_that_was_stopped_gives_its_domain_to_another_user(spawners: list[CourseSpawner]) -> None:
    with pytest.raises(NoDomainLeftError):
        start_until_refused(spawners)
    left = domain_of(spawners[0])
    spawners[0].clear_state()
    spawners.append(CourseSpawner())
    spawners[-1].claim_domain()
    assert domain_of(spawners[-1]) == left


def test_a_hub_that_starts_again_keeps_the_domains_of_running_servers(spawners: list[CourseSpawner]) -> None:
    spawners.extend((CourseSpawner(), CourseSpawner()))
    spawners[0].claim_domain()
    state = spawners[0].get_state()
    spawners[0].clear_state()  # the hub's process has ended
    spawners[1].load_state(state)
    assert domain_of(spawners[1]) == state["ros_domain"]
    with pytest.raises(NoDomainLeftError):
        start_until_refused(spawners)
    assert [spawner for spawner in spawners[2:-1] if domain_of(spawner) == state["ros_domain"]] == []
