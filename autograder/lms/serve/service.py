"""The process of the service: it listens at the address that the hub sets, and grades until it is stopped or killed."""

from __future__ import annotations

import asyncio
import os
import secrets
import signal
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import urlsplit

from tornado.httpserver import HTTPServer

from autograder.exceptions import UsageError
from autograder.lms.serve.exchange import Exchange
from autograder.lms.serve.grading import Grader, GradingOptions
from autograder.lms.serve.handlers import application
from autograder.lms.serve.settings import Settings
from autograder.lms.serve.shared import Service
from autograder.lms.serve.store import Store
from autograder.notebook.handing_in import MAX_ANSWER
from autograder.run.sandbox import require

# The variables that the hub sets for a service.
TOKEN, NAME, URL, PREFIX = (
    "JUPYTERHUB_API_TOKEN",
    "JUPYTERHUB_SERVICE_NAME",
    "JUPYTERHUB_SERVICE_URL",
    "JUPYTERHUB_SERVICE_PREFIX",
)


@dataclass(frozen=True)
class Address:
    """The address at which the service listens, and the prefix of its paths on the hub."""

    host: str
    port: int
    prefix: str


def address(environment: Mapping[str, str]) -> Address:
    """Return the address that the hub sets for its service. Raises UsageError if no hub started this process."""
    missing = [name for name in (TOKEN, NAME, URL, PREFIX) if not environment.get(name)]
    if missing:
        raise UsageError(
            f"{', '.join(missing)} {'is' if len(missing) == 1 else 'are'} not set: `autograder serve` is started by a "
            "JupyterHub, as one of its services; docs/serve.md has the lines for its configuration"
        )
    url, prefix = urlsplit(environment[URL]), environment[PREFIX]
    if url.scheme != "http" or url.hostname is None or url.port is None:
        raise UsageError(f"{URL} is {environment[URL]!r}: give the service an address such as http://127.0.0.1:10180")
    return Address(url.hostname, url.port, f"/{prefix.strip('/')}/")


def serve(settings: Settings, folder: Path, options: GradingOptions, listen_at: Address) -> None:
    """Serve until this process ends, which may happen at any time without losing an answer.

    Raises UsageError if the folder or the address cannot be used, and IsolationError if the sandbox cannot be created.
    """
    require(options.isolation)
    # Ctrl-C ends the process at once, like any other signal. The next start repeats the running gradings.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    store = Store(folder)
    asyncio.run(_serve(settings, store, options, listen_at))


async def _serve(settings: Settings, store: Store, options: GradingOptions, listen_at: Address) -> None:
    grader = Grader(settings, store, options)
    service = Service(settings, store, grader, listen_at.prefix)
    # Cookies expire when this process ends. The browser then logs in again without asking the user.
    server = HTTPServer(application(service, secrets.token_bytes(32)), max_body_size=4 * MAX_ANSWER)
    try:
        server.listen(listen_at.port, listen_at.host)
    except OSError as error:
        raise UsageError(
            f"{listen_at.host}:{listen_at.port}: cannot listen there ({os.strerror(error.errno or 0)})"
        ) from None
    if settings.exchange is None:
        await grader.run()
    else:
        await asyncio.gather(grader.run(), Exchange(service, settings.exchange).watch())
