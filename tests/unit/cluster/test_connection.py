"""Machines of a cluster have the same versions, and connect by TLS unless they are one machine."""

from __future__ import annotations

import ssl
import stat
import subprocess
from pathlib import Path

import pytest

from autograder import course_paths
from autograder.exceptions import UsageError
from autograder.grade.cluster.connection import CERTIFICATE, KEY, connected, require_address
from autograder.grade.cluster.machine import difference, resource, resources
from autograder.run.sandbox import Isolation


@pytest.mark.parametrize(
    "address",
    ["tls://grader.example.edu:8786", "tcp://127.0.0.1:8786", "tcp://localhost:8786", "tcp://[::1]:1", "tls://[::1]:1"],
)
def test_tls_is_allowed_to_any_address_and_unencrypted_only_to_this_machine(address: str) -> None:
    require_address(address)


@pytest.mark.parametrize(
    "address", ["", "grader", "grader:8786", "http://grader:80", "tls://:8786", "tls://grader:port"]
)
def test_an_invalid_scheduler_address_is_a_usage_error(address: str) -> None:
    with pytest.raises(UsageError, match="is not a valid scheduler address: use tls://HOST:PORT, or `local`"):
        require_address(address)


@pytest.mark.promise("Addresses of other machines are only used with TLS.")
def test_submissions_never_leave_the_machine_unencrypted() -> None:
    with pytest.raises(UsageError, match=r"unencrypted: start scheduler and workers with tls://"):
        require_address("tcp://10.0.0.1:8786")


def test_a_missing_certificate_is_named(tmp_path: Path) -> None:
    missing = pytest.raises(UsageError, match=r"cluster.pem does not exist: run `make cluster-certificates`")
    with missing, connected("tls://10.0.0.1:8786", 1, tmp_path):
        pytest.fail("connected")


@pytest.mark.promise("make cluster-certificates")
def test_a_certificate_works_for_server_and_client_and_only_its_owner_can_read_it(tmp_path: Path) -> None:
    command = ["make", "-f", str(course_paths.ROOT / "Makefile"), "cluster-certificates"]
    subprocess.run(command, cwd=tmp_path, check=True)
    certificate, key = (tmp_path / "cluster-certificates" / name for name in (CERTIFICATE, KEY))
    context = ssl.create_default_context(cafile=str(certificate))
    context.load_cert_chain(certificate, key)
    assert len(context.get_ca_certs()) == 1
    assert stat.S_IMODE(key.stat().st_mode) == 0o600
    before = key.read_text()
    subprocess.run(command, cwd=tmp_path, check=True)
    assert key.read_text() == before


OWN_RESOURCE = "autograder 02_nodes 5ca1ab1e0000 10cc10cc10cc 3.12 stand-ins bubblewrap"


@pytest.mark.promise("It gets no submissions, and the client says what differs.")
@pytest.mark.parametrize(
    ("resources", "reason"),
    [
        ([OWN_RESOURCE], ""),
        ([OWN_RESOURCE.replace("bubblewrap", "process"), OWN_RESOURCE], ""),
        ([OWN_RESOURCE.replace("5ca1ab1e0000", "0")], "its suite of 02_nodes is 0, but here it is 5ca1ab1e0000"),
        ([OWN_RESOURCE.replace("02_nodes", "03_interfaces")], "its suite of 02_nodes is missing"),
        ([OWN_RESOURCE.replace("10cc10cc10cc", "0")], "its requirements.lock is 0"),
        ([OWN_RESOURCE.replace("3.12", "3.10")], "its Python is 3.10, but here it is 3.12"),
        ([OWN_RESOURCE.replace("stand-ins", "launch-3.4.3")], "its launch is launch-3.4.3, but here it is stand-ins"),
        (
            [OWN_RESOURCE.replace("bubblewrap", "process")],
            "it does not support the isolation level bubblewrap: `autograder doctor`",
        ),
        (["GPU"], "it does not report its versions: start it with `--preload autograder.grade.cluster`"),
    ],
)
def test_a_worker_with_other_versions_is_rejected_with_the_reason(resources: list[str], reason: str) -> None:
    assert difference(OWN_RESOURCE, resources).startswith(reason)
    assert (difference(OWN_RESOURCE, resources) == "") is (OWN_RESOURCE in resources)


def test_a_machine_meets_its_own_requirements() -> None:
    assert difference(resource("02_nodes", Isolation.PROCESS), resources()) == ""
