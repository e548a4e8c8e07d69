"""Domains of one's own: claimed while they are used, free again afterwards, shared when there is no other."""

from __future__ import annotations

import subprocess
import sys

from autograder.ros.domains import DOMAINS, Domain

HOLD = "from autograder.ros.domains import Domain; domain = Domain({}); print(domain.number, flush=True); input()"


def test_two_claims_from_the_same_number_get_different_domains() -> None:
    with Domain(7) as one, Domain(7) as other:
        assert one.number != other.number
        assert {one.number, other.number} <= set(DOMAINS)


def test_a_domain_of_another_process_is_free_after_its_end() -> None:
    command = [sys.executable, "-c", HOLD.format(30)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        number = int(process.stdout.readline())
        start = DOMAINS.index(number)
        with Domain(start) as mine:
            assert mine.number != number
        process.kill()
        process.wait()
    with Domain(start) as mine:
        assert mine.number == number


def test_a_domain_is_shared_if_all_are_taken() -> None:
    claims = [Domain() for _ in range(len(DOMAINS) + 1)]
    try:
        with Domain(3) as shared:
            assert shared.number == DOMAINS[3]
    finally:
        for claim in claims:
            claim.close()
