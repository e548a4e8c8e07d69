"""A user of a JupyterHub, who logs in by the form, starts a server, and sends requests to Jupyter and nbgrader."""

from __future__ import annotations

import json
import re
import uuid
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

import requests
import websocket

from autograder.lms.hub.trial import Hub

PATIENCE = 600.0  # seconds: a deadline, not an expectation


@dataclass
class User:
    """A logged-in user with a running server."""

    hub: Hub
    name: str
    session: requests.Session = field(default_factory=requests.Session)

    def log_in(self) -> User:
        """Log in by the hub's form, create a token, and start the server; return this user."""
        page = f"{self.hub.url}/hub/login"
        self.session.get(page, timeout=PATIENCE).raise_for_status()
        form = {"username": self.name, "password": self.hub.password, "_xsrf": self._xsrf()}
        answer = self.session.post(page, data=form, allow_redirects=False, timeout=PATIENCE)
        assert answer.status_code == 302, f"{self.name} cannot log in: {answer.status_code}"
        self.session.get(f"{self.hub.url}/hub/home", timeout=PATIENCE).raise_for_status()
        tokens = f"{self.hub.url}/hub/api/users/{self.name}/tokens"
        token = self.session.post(tokens, headers={"X-XSRFToken": self._xsrf()}, json={}, timeout=PATIENCE)
        token.raise_for_status()
        self.session = requests.Session()
        self.session.headers["Authorization"] = f"token {token.json()['token']}"
        server = f"{self.hub.url}/hub/api/users/{self.name}/server"
        self.session.post(server, timeout=PATIENCE).raise_for_status()
        with self.session.get(f"{server}/progress", stream=True, timeout=PATIENCE) as events:
            progress = [json.loads(line[6:]) for line in events.iter_lines() if line.startswith(b"data: ")]
        assert progress[-1].get("ready"), progress
        return self

    def request(self, method: str, path: str, **arguments: Any) -> Any:
        """Return the answer of this user's server to a request, as plain data."""
        url = f"{self.hub.url}/user/{self.name}/{path}"
        answer = self.session.request(method, url, timeout=PATIENCE, **arguments)
        assert answer.ok, f"{method} {path}: {answer.status_code} {answer.text[:2000]}"
        return json.loads(answer.text) if answer.text else None

    def read(self, path: str) -> str:
        """Return the text of a file in this user's home folder."""
        answer = self.session.get(f"{self.hub.url}/user/{self.name}/files/{path}", timeout=PATIENCE)
        answer.raise_for_status()
        return answer.text

    def nbgrader(self, path: str, **arguments: Any) -> Any:
        """POST to one of nbgrader's extensions; return the value in its answer, which must be a success."""
        answer = self.request("POST", path, **arguments)
        assert answer["success"], answer
        return answer.get("value")

    def run(self, notebook: str, *cells: str) -> list[str]:
        """Run cells in a kernel in the notebook's folder; return the output of each. None may raise an error."""
        body = {"path": notebook, "name": notebook, "type": "notebook", "kernel": {"name": "python3"}}
        session = self.request("POST", "api/sessions", json=body)
        connection = self._connect(f"api/kernels/{session['kernel']['id']}/channels")
        try:
            return [self._run_cell(connection, cell) for cell in cells]
        finally:
            connection.close()
            self.request("DELETE", f"api/sessions/{session['id']}")

    def in_terminal(self, command: str) -> str:
        """Run a command in a new terminal; return the word that it prints, or an empty string."""
        name = self.request("POST", "api/terminals")["name"]
        connection = self._connect(f"terminals/websocket/{name}")
        try:
            connection.send(json.dumps(["stdin", f'echo "<$({command})>"\r']))
            printed = ""
            while not (word := re.search(r"<(\w*)>", printed)):
                kind, *content = json.loads(connection.recv())
                printed += str(content[0]) if kind == "stdout" else ""
            return word[1]
        finally:
            connection.close()
            self.request("DELETE", f"api/terminals/{name}")

    def _connect(self, path: str) -> websocket.WebSocket:
        url = f"ws://{urlsplit(self.hub.url).netloc}/user/{self.name}/{path}"
        header = {"Authorization": str(self.session.headers["Authorization"])}
        return websocket.create_connection(url, timeout=PATIENCE, header=header)

    def _run_cell(self, connection: websocket.WebSocket, cell: str) -> str:
        message_id = uuid.uuid4().hex
        header = {"msg_id": message_id, "msg_type": "execute_request", "username": self.name, "session": message_id}
        content = {"code": cell, "silent": False, "store_history": True, "user_expressions": {}, "allow_stdin": False}
        message = {"header": {**header, "version": "5.3"}, "parent_header": {}, "metadata": {}, "content": content}
        connection.send(json.dumps({**message, "channel": "shell", "buffers": []}))
        printed = ""
        while True:
            answer = json.loads(connection.recv())
            if answer["parent_header"].get("msg_id") != message_id:
                continue
            kind, content = answer["msg_type"], answer["content"]
            if kind == "stream":
                printed += content["text"]
            if kind == "error":
                raise AssertionError("\n".join(content["traceback"]))
            if kind == "status" and content["execution_state"] == "idle":
                return printed

    def _xsrf(self) -> str:
        return next(str(cookie.value) for cookie in self.session.cookies if cookie.name == "_xsrf")
