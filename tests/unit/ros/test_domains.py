"""Domains: claimed while they are used, free again afterwards, one for each user, refused when none is left."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator
from contextlib import ExitStack

import pytest

from autograder.ros.domains import DOMAINS, Domain

HOLD = "from autograder.ros.domains import Domain; domain = Domain({}); print(domain.number, flush=True); input()"
ADA, BEN = 4_000_000_000 + os.getpid(), 4_100_000_000 + os.getpid()  # ids that no user of a machine has
AUTOGRADER = (sys.executable, "-m", "autograder", "ros")
LAB = "import os; print(os.environ['ROS_DOMAIN_ID'], flush=True); input()"
TAKE_ALL = """\
import sys
from autograder.ros.domains import Domain
from autograder.ros.exceptions import NoFreeDomainError
domains = []
try:
    while len(domains) < 200:
        domains.append(Domain())
except NoFreeDomainError as exception:
    error = exception
"""
KERNEL = (
    "import os; from autograder.notebook import ros; ros(); print(os.environ['ROS_DOMAIN_ID'], flush=True); input()"
)


@pytest.fixture
def claims() -> Iterator[ExitStack]:
    """Closes the claims that enter it."""
    with ExitStack() as stack:
        yield stack


def start_holder(claims: ExitStack, *command: str) -> tuple[subprocess.Popen[str], int]:
    """Start a program that prints its domain and keeps it; return it and the domain's number."""
    environ = {name: value for name, value in os.environ.items() if name != "ROS_DOMAIN_ID"}
    process = claims.enter_context(
        subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environ)
    )
    claims.callback(process.kill)
    assert process.stdout is not None
    return process, int(process.stdout.readline())


def run_in_separate_network(code: str) -> subprocess.CompletedProcess[str]:
    """Run Python code in a network without other programs, which would be refused while the code takes all domains."""
    network = ["unshare", "--user", "--map-root-user", "--net"]
    if subprocess.run([*network, "true"], capture_output=True, check=False).returncode != 0:
        pytest.skip("this machine allows no network namespaces")
    environ = {name: value for name, value in os.environ.items() if name != "ROS_DOMAIN_ID"}
    command = [*network, sys.executable, "-c", code]
    return subprocess.run(command, capture_output=True, text=True, check=False, env=environ)


def test_two_claims_from_the_same_number_get_different_domains() -> None:
    with Domain(7) as one, Domain(7) as other:
        assert one.number != other.number
        assert {one.number, other.number} <= set(DOMAINS)


def test_a_domain_of_another_process_is_free_after_its_end(claims: ExitStack) -> None:
    process, number = start_holder(claims, sys.executable, "-c", HOLD.format(30))
    start = DOMAINS.index(number)
    with Domain(start) as mine:
        assert mine.number != number
    process.kill()
    process.wait()
    with Domain(start) as mine:
        assert mine.number == number


def test_a_claim_is_refused_with_a_sentence_if_all_domains_are_in_use() -> None:
    completed = run_in_separate_network(TAKE_ALL + "print(len({domain.number for domain in domains}), error)")
    assert completed.stdout == (
        "101 all 101 ROS domains of this machine are in use: stop notebooks and programs that you do not need, or try "
        "again later\n"
    )


@pytest.mark.promise("Other users of the machine have other domains.")
def test_130_kernels_of_two_users_have_two_domains(claims: ExitStack) -> None:
    numbers = {
        user: {claims.enter_context(Domain(user=user)).number for _ in range(kernels)}
        for user, kernels in ((ADA, 70), (BEN, 60))
    }
    assert [len(domains) for domains in numbers.values()] == [1, 1]
    assert numbers[ADA] != numbers[BEN]


def test_a_user_keeps_the_domain_until_the_last_program_ends() -> None:
    first_claim = Domain(user=ADA)
    start, second = DOMAINS.index(first_claim.number), Domain(user=ADA)
    first_claim.close()
    with Domain(start) as other, Domain(start, user=BEN) as of_ben, Domain(user=ADA) as third:
        assert first_claim.number == second.number == third.number
        assert first_claim.number not in {other.number, of_ben.number}
    second.close()
    with Domain(start) as other:
        assert other.number == first_claim.number


def test_a_users_programs_that_start_at_the_same_time_share_one_domain(claims: ExitStack) -> None:
    code = HOLD.format(f"user={ADA}")
    command = [sys.executable, "-c", code]
    processes = [
        claims.enter_context(subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True))
        for _ in range(6)
    ]
    numbers = [process.stdout.readline() for process in processes if process.stdout is not None]
    for process in processes:
        process.kill()
    assert len(numbers) == len(processes)
    assert len(set(numbers)) == 1


@pytest.mark.promise(
    "Your notebooks and terminals share one ROS domain",
    '`autograder ros COMMAND` and `eval "$(autograder ros)"` find it.',
)
def test_notebooks_terminals_and_their_programs_share_the_users_domain(claims: ExitStack) -> None:
    _, of_kernel = start_holder(claims, sys.executable, "-c", KERNEL)
    _, of_lab = start_holder(claims, *AUTOGRADER, sys.executable, "-c", LAB)
    _, of_terminal_of_lab = start_holder(claims, *AUTOGRADER, *AUTOGRADER, sys.executable, "-c", KERNEL)
    _, of_shell = start_holder(claims, "bash", "-c", f'eval "$({" ".join(AUTOGRADER)})"; echo $ROS_DOMAIN_ID')
    assert {of_kernel, of_lab, of_terminal_of_lab, of_shell} == {of_kernel}


def test_a_command_keeps_the_domain_for_as_long_as_it_runs(claims: ExitStack) -> None:
    process, number = start_holder(claims, *AUTOGRADER, sys.executable, "-c", LAB)
    with Domain(DOMAINS.index(number), user=ADA) as other:
        assert other.number != number
    process.kill()
    process.wait()


@pytest.mark.promise("and so does `autograder ros`")
def test_no_command_runs_if_no_domain_is_left() -> None:
    command = [*AUTOGRADER, "echo", "ran"]
    completed = run_in_separate_network(TAKE_ALL + f"import subprocess; sys.exit(subprocess.run({command}).returncode)")
    assert (completed.returncode, completed.stdout) == (1, "")
    assert completed.stderr.startswith("ROS 2: all 101 ROS domains of this machine are in use: stop notebooks")
