"""No two users of a hub share a ROS domain, and if none is left, a server is refused with an explanation."""

from __future__ import annotations

import os
import pwd
from collections.abc import Iterator
from types import SimpleNamespace

import pytest

from autograder.lms.hub.spawner import CourseSpawner
from autograder.ros.domains import DOMAINS, Domain
from tests.unit.ros.test_domains import TAKE_ALL, run_in_separate_network

NAMES = [user.pw_name for user in pwd.getpwall() if user.pw_uid not in (0, os.getuid())][
    :3
]  # users that each machine has
REFUSED = """
from types import SimpleNamespace
from autograder.lms.hub.spawner import CourseSpawner, NoServerError
try:
    CourseSpawner(user=SimpleNamespace(name="root")).claim_domain()
except NoServerError as error:
    print(error.jupyterhub_message)  # the hub shows it
"""


@pytest.fixture
def spawners() -> Iterator[list[CourseSpawner]]:
    """Spawners of three users; in the end their servers are stopped."""
    created = [CourseSpawner(user=SimpleNamespace(name=name)) for name in NAMES]
    yield created
    for spawner in created:
        spawner.clear_state()


def domain_of(spawner: CourseSpawner) -> int:
    return int(spawner.get_state()["ros_domain"])


def test_each_user_has_a_domain_also_for_programs_that_the_hub_does_not_start(spawners: list[CourseSpawner]) -> None:
    for spawner in spawners:
        spawner.claim_domain()
    assert len({domain_of(spawner) for spawner in spawners}) == len(spawners) == 3
    with Domain(user=pwd.getpwnam(NAMES[0]).pw_uid) as elsewhere:
        assert elsewhere.number == domain_of(spawners[0])


def test_a_server_is_refused_with_a_sentence_if_no_domain_is_left() -> None:
    assert run_in_separate_network(TAKE_ALL + REFUSED).stdout.startswith(
        "All 101 ROS domains of this machine are in use. A server that"
    )


def test_a_server_that_was_stopped_gives_its_domain_to_another_user(spawners: list[CourseSpawner]) -> None:
    spawners[0].claim_domain()
    number = domain_of(spawners[0])
    spawners[0].clear_state()
    spawners[1].claim_domain(number)
    assert domain_of(spawners[1]) == number


def test_a_hub_that_starts_again_keeps_the_domains_of_running_servers(spawners: list[CourseSpawner]) -> None:
    spawners[0].claim_domain()
    state = spawners[0].get_state()
    spawners[0].clear_state()  # the hub's process has ended
    restarted = CourseSpawner(user=SimpleNamespace(name=NAMES[0]))
    restarted.load_state(state)
    with Domain(DOMAINS.index(domain_of(restarted))) as other_domain:
        assert domain_of(restarted) == state["ros_domain"] != other_domain.number
    restarted.clear_state()
