"""`submit` hands an assignment in to the hub's service, which grades it immediately."""

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
TOKEN = "JUPYTERHUB_API_TOKEN"  # the variable with the token of the user's server
PAUSES = (1.0, 2.0, 4.0, 8.0)  # s; how long to wait after each failed try, for example while the service restarts
TIMEOUT = 60.0  # s; how long to wait for a reply
# The date of each file in a zip: the earliest possible one. With the files' own dates, equal answers would differ.
DATE = (1980, 1, 1, 0, 0, 0)
MAX_REPLY = 100_000  # bytes; the rest of a longer reply is not read
MAX_ANSWER = 16 * 1024 * 1024  # bytes; the largest zip that is sent
UNSURE = "Your answer may or may not have arrived. Run the cell again: it is handed in only once."

_unconfirmed: dict[tuple[str, str], str] = {}  # the keys of answers without a receipt, by assignment and digest


@dataclass(frozen=True)
class Receipt:
    """The service's confirmation that it stored a hand-in and will grade it."""

    assignment: str
    number: int
    handed_in: datetime
    tries_left: int
    page: str  # the path of its page on the hub

    @property
    def sentence(self) -> str:
        tries = f"{self.tries_left} more {'try' if self.tries_left == 1 else 'tries'} today"
        at = self.handed_in.astimezone().strftime("%H:%M:%S")
        return f"{self.assignment} is handed in as number {self.number}, at {at}, as last saved. You have {tries}."

    def __repr__(self) -> str:
        return f"{self.sentence}\nIts feedback: {self.page} on the hub"

    def _repr_html_(self) -> str:
        link = f'<a href="{html.escape(self.page)}" target="_blank">Its feedback</a>'
        return f'<div style="{STYLE.format(colour="#009e73")}">{html.escape(self.sentence)} {link}</div>'


def submit(assignment: str, folder: str | Path = ".") -> Receipt | Notice:
    """Hand in the assignment's folder as it is saved: the notebook, and the packages in `ws/src`.

    Returns:
        The service's receipt, or a notice that says why nothing was handed in.

    Raises:
        UsageError: the assignment does not exist.
    """
    if grading():
        return Notice("Nothing is handed in while a notebook is graded.")
    if assignment not in (known := suites.checkable_assignments()):
        raise UsageError(f"{assignment!r} is not an assignment to hand in; choose one of: {', '.join(known)}")
    service, token = os.environ.get(SERVICE), os.environ.get(TOKEN)
    if not service or not token:
        return Notice(
            "This hub does not grade submissions. Hand in as your instructor told you, for example the folder as a zip."
        )
    try:
        files = intake.read_files(Path(folder), assignment)
    except StudentError as error:
        return Notice("Nothing was handed in.", str(error), TROUBLE)
    answer = make_zip(files)
    if len(answer) > MAX_ANSWER:
        size = (
            f"The folder is {len(answer) / 2**20:.0f} MiB as a zip, but at most {MAX_ANSWER // 2**20} MiB are accepted."
        )
        return Notice("Nothing was handed in.", f"{size} Move large files that are not part of it elsewhere.", TROUBLE)
    digest = hashlib.sha256(answer).hexdigest()
    key = _unconfirmed.setdefault((assignment, digest), secrets.token_hex(16))
    try:
        receipt = hand_in(service, token, assignment, key, answer)
    except HandInError as error:
        if error.is_sure:
            del _unconfirmed[assignment, digest]
        return Notice("Nothing was handed in." if error.is_sure else UNSURE, str(error), TROUBLE)
    del _unconfirmed[assignment, digest]
    return receipt


class HandInError(Exception):
    """The service did not accept the answer. If `is_sure` is False, it may have done so, but its reply was lost."""

    def __init__(self, sentence: str, *, is_sure: bool = True) -> None:
        super().__init__(sentence)
        self.is_sure = is_sure


def make_zip(files: Sequence[SubmittedFile]) -> bytes:
    """Return files as a zip. The zips of equal files are equal."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w", zipfile.ZIP_DEFLATED) as archive:
        for file in sorted(files, key=lambda submitted: submitted.path):
            info = zipfile.ZipInfo(str(file.path), DATE)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = (0o100755 if file.executable else 0o100644) << 16
            archive.writestr(info, file.data)
    return data.getvalue()


def hand_in(service: str, token: str, assignment: str, key: str, answer: bytes) -> Receipt:
    """Send an answer to the service at this address, and return its receipt.

    If the service does not reply, for example because it is starting, the answer is sent again with the same key. The
    service stores an answer with a known key only once. Raises HandInError if the service does not accept the answer.
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
            if error.code not in (502, 503, 504) or pause is None:  # from the proxy while the service starts
                raise HandInError(_error_sentence(error), is_sure=error.code not in (502, 504)) from None
        except (OSError, http.client.HTTPException) as error:
            if pause is None:
                raise HandInError(f"The service does not answer: {error}.", is_sure=False) from None
        time.sleep(pause)
    raise AssertionError("the last try returns or raises")


def _receipt(assignment: str, data: bytes) -> Receipt:
    try:
        reply = json.loads(data)
        at = datetime.fromisoformat(reply["handed_in"])
        return Receipt(assignment, int(reply["number"]), at, int(reply["tries_left"]), str(reply["page"]))
    except (ValueError, KeyError, TypeError):
        raise HandInError("The reply is not from the grading service: tell your instructor.", is_sure=False) from None


def _error_sentence(error: urllib.error.HTTPError) -> str:
    try:
        return str(json.loads(error.read(MAX_REPLY))["error"])
    except (ValueError, KeyError, TypeError, OSError):
        return f"The service replied {error.code} {error.reason}. Tell your instructor."
