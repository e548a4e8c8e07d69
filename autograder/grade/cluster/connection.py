"""Connects to a scheduler, with TLS unless it runs on this machine."""

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
CONNECT_TIMEOUT_SECONDS = 30  # real time to wait for the scheduler's first response, or for the client to close


@contextlib.contextmanager
def connected(scheduler: str, jobs: int, certificates: Path) -> Iterator[Client]:
    """Yield a client that is connected to a scheduler.

    Args:
        scheduler: its address, or `local` for a cluster on this machine that ends with the client.
        jobs: how many submissions a `local` cluster grades at once.
        certificates: the folder from `make cluster-certificates`, for TLS.

    Raises:
        ClusterError: the scheduler does not respond.
        UsageError: the address or a certificate cannot be used.
    """
    # This program reports a lost connection itself, in one sentence.
    logging.getLogger("distributed").setLevel(logging.CRITICAL)
    if scheduler == LOCAL:
        # By default, the cluster removes a worker that takes longer than 15 s to reconnect.
        long_timeout = dask.config.set({"distributed.deploy.lost-worker-timeout": 600})
        with long_timeout, _local(jobs) as cluster, Client(cluster, set_as_default=False) as client:
            yield client
        return
    require_address(scheduler)
    security = _security(certificates) if scheduler.startswith("tls://") else Security(require_encryption=False)
    try:
        client = Client(scheduler, security=security, timeout=CONNECT_TIMEOUT_SECONDS, set_as_default=False)
    except OSError as error:
        raise ClusterError(f"no scheduler responds at {scheduler}: {error}") from None
    try:
        yield client
    finally:
        with contextlib.suppress(OSError):  # the scheduler may be gone
            client.close(timeout=CONNECT_TIMEOUT_SECONDS)


def require_address(scheduler: str) -> None:
    """Raise UsageError unless the scheduler's address is valid: `tls` for any machine, `tcp` only for this one."""
    try:
        address = urlsplit(scheduler)
        host, port = address.hostname, address.port
    except ValueError:
        host, port = None, None
    if not host or port is None or address.scheme not in ("tcp", "tls"):
        raise UsageError(f"{scheduler!r} is not a valid scheduler address: use tls://HOST:PORT, or `{LOCAL}`")
    if address.scheme == "tcp" and not _loopback(host):
        raise UsageError(
            f"{scheduler} would send submissions and marks unencrypted: start scheduler and workers with tls:// "
            "(`make cluster-certificates` creates the certificates)"
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
                f"{path} does not exist: run `make cluster-certificates` to create it, or give its folder with "
                "--certificates"
            )
    return Security(
        tls_ca_file=str(certificate), tls_client_cert=str(certificate), tls_client_key=str(key), require_encryption=True
    )


def _local(jobs: int) -> LocalCluster:
    # A single process with one thread for each grading suffices, because a thread only waits for another process.
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
