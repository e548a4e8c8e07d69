"""A real hub with users, and the service beside it, in a separate process that can be killed and started again."""

from __future__ import annotations

import json
import multiprocessing
import os
import re
import secrets
import signal
import socket
import subprocess
import sys
import threading
import urllib.error
import urllib.request
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any

from autograder.notebook.handing_in import Receipt, hand_in
from tests.unit.serve import serving

PREFIX = "/services/autograder/"
PATIENCE = 280.0  # s: a deadline, not an expectation
SETTINGS = """
instructors: [grace]
assignments:
  02_nodes: {tries_a_day: 1000}
"""
FORKS = multiprocessing.get_context("forkserver")
FORKS.set_forkserver_preload(["tests.unit.serve.serving", "jsonschema.validators", "nbformat"])


def free_port() -> int:
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        return int(listener.getsockname()[1])


@dataclass
class Hub:
    """A separate JupyterHub: its address, the service's, and the tokens of users, created on request."""

    url: str
    service: str
    secret: str
    admin: str
    _tokens: dict[str, str] = field(default_factory=dict)

    def token(self, user: str) -> str:
        """Return the token of a user's server."""
        if user not in self._tokens:
            self._ask("POST", "users", {"usernames": [user]})
            self._tokens[user] = self._ask("POST", f"users/{user}/tokens", {})["token"]
        return self._tokens[user]

    def environment(self) -> dict[str, str]:
        """Return the environment variables that a hub sets for its service."""
        return {
            "JUPYTERHUB_API_TOKEN": self.secret,
            "JUPYTERHUB_API_URL": f"{self.url}/hub/api",
            "JUPYTERHUB_BASE_URL": "/",
            "JUPYTERHUB_HOST": self.url,
            "JUPYTERHUB_CLIENT_ID": "service-autograder",
            "JUPYTERHUB_OAUTH_CALLBACK_URL": f"{self.service}{PREFIX}oauth_callback",
            "JUPYTERHUB_OAUTH_ACCESS_SCOPES": json.dumps(["access:services!service=autograder"]),
            "JUPYTERHUB_SERVICE_NAME": "autograder",
            "JUPYTERHUB_SERVICE_PREFIX": PREFIX,
            "JUPYTERHUB_SERVICE_URL": self.service,
        }

    def _ask(self, method: str, path: str, body: dict[str, Any]) -> Any:
        request = urllib.request.Request(
            f"{self.url}/hub/api/{path}",
            json.dumps(body).encode(),
            {"Authorization": f"token {self.admin}"},
            method=method,
        )
        with urllib.request.urlopen(request, timeout=PATIENCE) as reply:
            return json.loads(reply.read())


@contextmanager
def running_hub(folder: Path) -> Iterator[Hub]:
    """Start a hub, and wait until it listens."""
    url, service = (f"http://127.0.0.1:{free_port()}" for _ in range(2))
    hub = Hub(url, service, secret=secrets.token_hex(16), admin=secrets.token_hex(16))
    values = {"HUB": hub.url, "SERVICE": hub.service, "SERVICE_TOKEN": hub.secret, "ADMIN_TOKEN": hub.admin}
    environment = {**os.environ, **{f"TEST_{name}": value for name, value in {**values, "FOLDER": str(folder)}.items()}}
    config = Path(__file__).with_name("hub_config.py")
    command = [sys.executable, "-m", "jupyterhub", "-f", str(config)]
    with subprocess.Popen(command, cwd=folder, env=environment, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        lines = []
        try:
            for line in process.stderr:
                lines.append(line)
                if "Hub API listening" in line:
                    break
            else:
                raise AssertionError("".join(lines))
            threading.Thread(target=process.stderr.read, daemon=True).start()  # the hub never blocks on a full pipe
            yield hub
        finally:
            process.terminate()


@dataclass
class Classroom:
    """The service of a hub, with a folder of its own."""

    hub: Hub
    folder: Path
    settings: str = SETTINGS
    process: BaseProcess | None = None

    @property
    def url(self) -> str:
        return f"{self.hub.service}{PREFIX}"

    def start(self, **options: Any) -> None:
        """Start the service with only the sandbox replaced; `serving.serve` documents the options."""
        file = self.folder / "settings.yaml"
        file.write_text(self.settings)
        arguments = (file, self.folder / "data", self.hub.environment())
        self.process = FORKS.Process(target=serving.serve, args=arguments, kwargs=options)
        self.process.start()

    def listens(self) -> bool:
        """Return whether the service answers yet."""
        try:
            return bool(ask(self.url))
        except OSError:
            return False

    def kill(self) -> None:
        """Kill the service, as `kill -9` does."""
        assert self.process is not None
        self.process.kill()
        self.process.join()
        assert self.process.exitcode == -signal.SIGKILL

    def hand_in(self, student: str, answer: bytes, key: str = "", assignment: str = "02_nodes") -> Receipt:
        return hand_in(self.url, self.hub.token(student), assignment, key or secrets.token_hex(16), answer)

    def get(self, user: str, path: str = "") -> tuple[int, str]:
        """Return the status and the text that a user gets."""
        return ask(f"{self.url}{path}", self.hub.token(user))

    def wait_for_the_kill(self) -> None:
        """Wait until the service has killed itself."""
        assert self.process is not None
        self.process.join(PATIENCE)
        assert self.process.exitcode == -signal.SIGKILL

    def wait(self, condition: Callable[[], bool]) -> None:
        """Wait until the condition holds."""
        serving.wait(condition, PATIENCE)

    def wait_for_marks(self, count: int) -> None:
        """Wait until this many answers of the class are graded, as its page shows it."""
        self.wait(lambda: len(re.findall("<td>graded", self.get("grace", "class/02_nodes")[1])) == count)

    def results(self) -> list[dict[str, Any]]:
        """Return the results that count."""
        status, text = self.get("grace", "class/02_nodes/results.json")
        assert status == 200
        return list(json.loads(text))


def ask(url: str, token: str = "", method: str = "GET", body: bytes | None = None) -> tuple[int, str]:
    """Return the status and the text of a reply."""
    headers = {"Authorization": f"token {token}"} if token else {}
    try:
        with urllib.request.urlopen(
            urllib.request.Request(url, body, headers, method=method), timeout=PATIENCE
        ) as reply:
            return reply.status, reply.read().decode()
    except urllib.error.HTTPError as error:
        return error.code, error.read().decode()


def call_in_parallel(functions: Sequence[Callable[[], Any]]) -> list[Any]:
    """Call all functions at once, each in its own thread; return their results."""
    from concurrent.futures import ThreadPoolExecutor

    with ThreadPoolExecutor(len(functions)) as pool:
        return [future.result() for future in [pool.submit(function) for function in functions]]
