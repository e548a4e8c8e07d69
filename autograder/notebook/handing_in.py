"""`submit`: hands an assignment in to the hub's service, which grades it at once."""

from __future__ import annotations

import hashlib
import html
import http.client
import io
import json
import os
import secrets
import time
import urllib.error
import urllib.request
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime
from pathlib import Path
from urllib.parse import quote, urljoin

from autograder.exceptions import StudentError, UsageError
from autograder.notebook.notices import STYLE, TROUBLE, Notice
from autograder.submission import intake
from autograder.submission.intake import SubmittedFile
from autograder.suite import suites
from sim.grading import grading

SERVICE = "AUTOGRADER_SERVICE"  # the variable with the service's address, which the hub's configuration sets
TOKEN = "JUPYTERHUB_API_TOKEN"  # the variable with the token of one's own server
PAUSES = (1.0, 2.0, 4.0, 8.0)  # s between tries while the service starts again
TIMEOUT = 60.0  # s
DATE = (1980, 1, 1, 0, 0, 0)  # the first one that a zip can hold; no file's own matters
MAX_REPLY = 100_000  # bytes
MAX_ANSWER = 16 * 1024 * 1024  # bytes of an answer, packed
UNSURE = "Your answer may have arrived, or not. Run the cell again: it is handed in once."

_unsure: dict[tuple[str, str], str] = {}  # the keys of answers, by assignment and digest, without a receipt


@dataclass(frozen=True)
class Receipt:
    """The service's answer: the hand-in is kept, and will be graded."""

    assignment: str
    number: int
    handed_in: datetime
    tries_left: int
    page: str  # the path of its page on the hub

    @property
    def sentence(self) -> str:
        """What was handed in when, and what comes next."""
        tries = f"{self.tries_left} more {'try' if self.tries_left == 1 else 'tries'} today"
        at = self.handed_in.astimezone().strftime("%H:%M:%S")
        return f"{self.assignment} is handed in as number {self.number}, at {at}, as it is saved. You have {tries}."

    def __repr__(self) -> str:
        return f"{self.sentence}\nIts feedback: {self.page} on the hub"

    def _repr_html_(self) -> str:
        link = f'<a href="{html.escape(self.page)}" target="_blank">Its feedback</a>'
        return f'<div style="{STYLE.format(colour="#009e73")}">{html.escape(self.sentence)} {link}</div>'


def submit(assignment: str, folder: str | Path = ".") -> Receipt | Notice:
    """Hand in the assignment's folder as it is saved: the notebook, and the packages in `ws/src`.

    Returns what the service says: a receipt, or a notice that says why nothing was handed in. Raises UsageError if
    there is no such assignment.
    """
    if grading():
        return Notice("Nothing is handed in while a notebook is graded.")
    if assignment not in (there := suites.checkable_assignments()):
        raise UsageError(f"there is nothing to hand in for {assignment!r}; there is for: {', '.join(there)}")
    service, token = os.environ.get(SERVICE), os.environ.get(TOKEN)
    if not service or not token:
        return Notice(
            "This is not a hub that grades at once. Hand in as your instructor says: the folder as a zip, for example."
        )
    try:
        files = intake.read_files(Path(folder), assignment)
    except StudentError as error:
        return Notice("Nothing was handed in.", str(error), TROUBLE)
    answer = packed(files)
    if len(answer) > MAX_ANSWER:
        size = f"The folder is {len(answer) / 2**20:.0f} MiB as a zip, and an answer has at most {MAX_ANSWER // 2**20}."
        return Notice("Nothing was handed in.", f"{size} Move what is large and no part of it elsewhere.", TROUBLE)
    digest = hashlib.sha256(answer).hexdigest()
    key = _unsure.setdefault((assignment, digest), secrets.token_hex(16))
    try:
        receipt = hand_in(service, token, assignment, key, answer)
    except HandInError as error:
        if error.is_sure:
            del _unsure[assignment, digest]
        return Notice("Nothing was handed in." if error.is_sure else UNSURE, str(error), TROUBLE)
    del _unsure[assignment, digest]
    return receipt


class HandInError(Exception):
    """The service did not take the answer, or, unless it `is_sure`, its own answer was lost on the way."""

    def __init__(self, sentence: str, *, is_sure: bool = True) -> None:
        super().__init__(sentence)
        self.is_sure = is_sure


def packed(files: Sequence[SubmittedFile]) -> bytes:
    """Return files as a zip; equal files make equal zips."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(files, key=lambda each: each.path):
            info = zipfile.ZipInfo(str(file.path), DATE)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o100755 if file.executable else 0o100644) << 16
            archive.writestr(info, file.data)
    return data.getvalue()


def hand_in(service: str, token: str, assignment: str, key: str, answer: bytes) -> Receipt:
    """Send an answer to the service at this address, and return its receipt.

    Where no answer comes, because the service is being started, it is sent again with the same key: that makes it the
    same hand-in, however often it arrives. Raises HandInError if the service does not take it.
    """
    url = urljoin(f"{service.rstrip('/')}/", f"hand-ins/{quote(assignment, safe='')}/{key}")
    headers = {"Authorization": f"token {token}", "Content-Type": "application/zip"}
    request = urllib.request.Request(url, answer, headers, method="PUT")
    opener = urllib.request.build_opener(urllib.request.ProxyHandler({}))  # the hub is reached without a proxy
    for pause in (*PAUSES, None):
        try:
            with opener.open(request, timeout=TIMEOUT) as reply:
                return _receipt(assignment, reply.read(MAX_REPLY))
        except urllib.error.HTTPError as error:
            if error.code not in (502, 503, 504) or pause is None:  # of the service, or of the proxy without it
                raise HandInError(_sentence(error), is_sure=error.code not in (502, 504)) from None
        except (OSError, http.client.HTTPException) as error:
            if pause is None:
                raise HandInError(f"The service does not answer: {error}.", is_sure=False) from None
        time.sleep(pause)
    raise AssertionError("the last try returns or raises")


def _receipt(assignment: str, data: bytes) -> Receipt:
    try:
        said = json.loads(data)
        at = datetime.fromisoformat(said["handed_in"])
        return Receipt(assignment, int(said["number"]), at, int(said["tries_left"]), str(said["page"]))
    except (ValueError, KeyError, TypeError):
        raise HandInError("What answers there is not the service: tell your instructor.", is_sure=False) from None


def _sentence(error: urllib.error.HTTPError) -> str:
    try:
        return str(json.loads(error.read(MAX_REPLY))["error"])
    except (ValueError, KeyError, TypeError, OSError):
        return f"The service says: {error.code} {error.reason}. Tell your instructor."
