"""Connects to a scheduler: with TLS wherever the address is not this machine's own."""

from __future__ import annotations

import contextlib
import ipaddress
import logging
from collections.abc import Iterator
from pathlib import Path
from urllib.parse import urlsplit

import dask
from distributed import Client, LocalCluster
from distributed.security import Security

from autograder.exceptions import UsageError
from autograder.grade.cluster.exceptions import ClusterError

CERTIFICATE, KEY = "cluster.pem", "cluster.key"
LOCAL = "local"
PRELOAD = "autograder.grade.cluster"
CONNECT_TIMEOUT_SECONDS = 30  # real time, for the first answer of a scheduler


@contextlib.contextmanager
def connected(scheduler: str, jobs: int, certificates: Path) -> Iterator[Client]:
    """Give a client of a scheduler.

    Args:
        scheduler: its address, or `local` for a cluster on this machine that ends with the client.
        jobs: how many submissions are graded at once by `local`.
        certificates: the folder that `make cluster-certificates` made, for TLS.

    Raises ClusterError if nobody answers there, and UsageError if the address or a certificate cannot be used.
    """
    # A lost connection is this program's to explain, in one sentence.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if scheduler == LOCAL:
        # The cluster would take away a worker that needs longer than 15 s to come back.
        stays = dask.config.set({"distributed.deploy.lost-worker-timeout": 600})
        with stays, _local(jobs) as cluster, Client(cluster, set_as_default=False) as client:
            yield client
        return
    require_address(scheduler)
    security = _security(certificates) if scheduler.startswith("tls://") else Security(require_encryption=False)
    try:
        client = Client(scheduler, security=security, timeout=CONNECT_TIMEOUT_SECONDS, set_as_default=False)
    except OSError as error:
        raise ClusterError(f"no scheduler answers at {scheduler}: {error}") from None
    try:
        yield client
    finally:
        with contextlib.suppress(OSError):  # the scheduler may be gone
            client.close(timeout=CONNECT_TIMEOUT_SECONDS)


def require_address(scheduler: str) -> None:
    """Raise UsageError unless this is the address of a scheduler: `tls` and any machine, or `tcp` and this one."""
    try:
        address = urlsplit(scheduler)
        host, port = address.hostname, address.port
    except ValueError:
        host, port = None, None
    if not host or port is None or address.scheme not in ("tcp", "tls"):
        raise UsageError(f"{scheduler!r} is no address of a scheduler: give tls://HOST:PORT, or `{LOCAL}`")
    if address.scheme == "tcp" and not _loopback(host):
        raise UsageError(
            f"{scheduler} would send submissions and marks in clear text: start scheduler and workers with tls:// "
            "(`make cluster-certificates` makes what they need)"
        )


def _loopback(host: str) -> bool:
    try:
        return ipaddress.ip_address(host).is_loopback
    except ValueError:
        return host == "localhost"


def _security(folder: Path) -> Security:
    certificate, key = folder / CERTIFICATE, folder / KEY
    for path in (certificate, key):
        if not path.is_file():
            raise UsageError(
                f"{path}: there is no such file; `make cluster-certificates` makes it, and --certificates names the "
                "folder"
            )
    return Security(
        tls_ca_file=str(certificate), tls_client_cert=str(certificate), tls_client_key=str(key), require_encryption=True
    )


def _local(jobs: int) -> LocalCluster:
    # One process with a thread for each grading: a thread only waits for the grading's own process.
    return LocalCluster(
        n_workers=1,
        threads_per_worker=jobs,
        processes=True,
        dashboard_address=None,
        memory_limit=None,
        preload=[PRELOAD],
        scheduler_kwargs={"preload": [PRELOAD]},
        silence_logs=logging.CRITICAL,
    )
