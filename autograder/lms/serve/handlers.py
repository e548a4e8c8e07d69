"""The HTTP handlers of the service, below its prefix on the hub. The hub authenticates all users.

    GET  ./                               the user's own hand-ins
    GET  ./feedback/NUMBER                the feedback on a hand-in; 403 if it belongs to another student
    GET  ./class/ASSIGNMENT               the class, for instructors
    GET  ./class/ASSIGNMENT/results.json  the results that count, for `autograder export`
    POST ./class/ASSIGNMENT/regrade       grades all hand-ins of the class again
    PUT  ./hand-ins/ASSIGNMENT/KEY        hands in the body; needs a token of the hub

A repeated PUT with the same key is the same hand-in, so a client without a response can retry.
"""

from __future__ import annotations

import json
import sqlite3
from http import HTTPStatus
from typing import Any

from jupyterhub.services.auth import HubOAuthCallbackHandler, HubOAuthenticated
from tornado.web import Application, HTTPError, RequestHandler, stream_request_body

from autograder.grade.store import RESULT
from autograder.lms.serve import pages
from autograder.lms.serve.hand_in import HandIn, counted_hand_in
from autograder.lms.serve.settings import AssignmentSettings, ShownParts
from autograder.lms.serve.shared import Refused, Service
from autograder.notebook.handing_in import MAX_ANSWER

KEY = r"[0-9a-f]{32}"  # the key of a hand-in, which the client chooses at random


def application(service: Service, cookie_secret: bytes) -> Application:
    """Return the application for the paths below the service's prefix, which begins and ends with a slash."""
    routes: list[tuple[str, type[RequestHandler]]] = [
        ("", HomeHandler),
        (r"feedback/([0-9]{1,9})", FeedbackHandler),
        (r"class/([^/]+)", ClassHandler),
        (r"class/([^/]+)/results\.json", ResultsHandler),
        (r"class/([^/]+)/regrade", RegradeHandler),
        (rf"hand-ins/([^/]+)/({KEY})", HandInHandler),
        ("oauth_callback", HubOAuthCallbackHandler),
    ]
    return Application(
        [(service.prefix + path, handler) for path, handler in routes],
        service=service,
        cookie_secret=cookie_secret,
        default_handler_class=NotFoundHandler,
    )


class HubUserHandler(HubOAuthenticated, RequestHandler):
    """A handler for users of the hub. Anyone else is redirected to the hub's login."""

    service: Service
    student: str

    def set_default_headers(self) -> None:
        self.set_header("X-Content-Type-Options", "nosniff")
        self.set_header("Content-Security-Policy", "frame-ancestors 'none'")
        self.set_header("Referrer-Policy", "same-origin")
        self.set_header("Cache-Control", "no-store")

    def initialize(self) -> None:
        self.service = self.application.settings["service"]

    async def prepare(self) -> None:
        try:
            async with self.service.hub_requests:
                # This caches the user for `current_user`, which would otherwise block the event loop.
                await self.hub_auth.get_user(self, sync=False)
        except HTTPError:
            raise Refused(503, "The hub could not identify you. Try again.") from None
        user = self.current_user
        if user is None and self.request.method in ("GET", "HEAD"):
            self.redirect(self.get_login_url())
            return
        if user is None or user["kind"] != "user":
            raise Refused(403, "Log in to the hub: its token was not accepted here.")
        self.student = user["name"]

    def write_error(self, status_code: int, **more: Any) -> None:
        """Respond with a page that contains the error's sentence, or for an internal error the name of its status."""
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish(pages.error(status_code, _sentence(status_code, more)))

    @property
    def is_instructor(self) -> bool:
        """Whether the user is an instructor."""
        return self.student in self.service.settings.instructors

    def assignment(self, name: str) -> AssignmentSettings:
        """Return the settings of an assignment. Raises Refused if the service has none for it."""
        settings = self.service.settings.assignments.get(name)
        if settings is None:
            raise Refused(404, "This assignment does not exist here.")
        return settings

    def require_instructor(self) -> None:
        """Raise Refused if the user is not an instructor."""
        if not self.is_instructor:
            raise Refused(403, "This page is for instructors.")

    def queue_position(self, hand_in: HandIn) -> str:
        """Describe the position of an ungraded hand-in in the queue."""
        grader = self.service.grader
        if grader.is_being_graded(hand_in.number):
            return "being graded"
        ahead = grader.ahead_of(hand_in.number)
        return "next" if ahead == 0 else f"waits: {ahead} before it"


class NotFoundHandler(HubUserHandler):
    """The handler of all other paths."""

    async def prepare(self) -> None:
        raise Refused(404, "This page does not exist.")


class HomeHandler(HubUserHandler):
    """The page with a student's own hand-ins."""

    def get(self) -> None:
        """Send the page."""
        service, hand_ins = self.service, self.service.store.of_student(self.student)
        positions = {hand_in.number: self.queue_position(hand_in) for hand_in in hand_ins if hand_in.mark is None}
        sections = pages.sections(service.settings, hand_ins, positions, self.student, service.now())
        zone = str(service.settings.zone)
        self.finish(pages.home(self.student, sections, teaches=self.is_instructor, prefix=service.prefix, zone=zone))


class FeedbackHandler(HubUserHandler):
    """The page of a hand-in."""

    def get(self, number: str) -> None:
        """Send instructors the whole page, and the student the parts that the settings allow."""
        hand_in = self.service.store.with_number(int(number))
        if hand_in is None:
            raise Refused(404, "This hand-in does not exist.")
        if hand_in.student != self.student and not self.is_instructor:
            raise Refused(403, "This is another student's feedback.")
        if hand_in.mark is None:
            self.finish(pages.state(hand_in, self.queue_position(hand_in)))
            return
        settings = self.service.settings.assignments.get(hand_in.assignment, AssignmentSettings())
        everything = ShownParts.EVERYTHING
        shown_parts = everything if self.is_instructor else settings.shown_to(self.student, self.service.now())
        self.finish(pages.feedback(hand_in, self.service.store.folder(hand_in.number), shown_parts))


class ClassHandler(HubUserHandler):
    """The page of a class."""

    def get(self, assignment: str) -> None:
        """Send the page to instructors."""
        self.require_instructor()
        self.assignment(assignment)
        store = self.service.store
        hand_ins, waiting, form = store.of_assignment(assignment), len(store.waiting()), self.xsrf_form_html()
        self.finish(pages.class_page(self.service.settings, assignment, hand_ins, waiting, self.service.prefix, form))


class RegradeHandler(HubUserHandler):
    """Grades a class again, for example after a check was fixed."""

    async def post(self, assignment: str) -> None:
        """Put each graded answer back into the queue. The hub's library has checked the form's XSRF token."""
        self.require_instructor()
        self.assignment(assignment)
        self.service.store.grade_again(assignment)
        await self.service.grader.notify()
        self.redirect(f"{self.service.prefix}class/{assignment}")


class ResultsHandler(HubUserHandler):
    """The results of a class that count, as a JSON file for `autograder export`."""

    def get(self, assignment: str) -> None:
        """Send the file to instructors."""
        self.require_instructor()
        best, store = self.assignment(assignment).best_counts, self.service.store
        by_student: dict[str, list[HandIn]] = {}
        for hand_in in store.of_assignment(assignment):
            by_student.setdefault(hand_in.student, []).append(hand_in)
        counted = filter(None, (counted_hand_in(hand_ins, best=best) for hand_ins in by_student.values()))
        self.set_header("Content-Type", "application/json")
        self.set_header("Content-Disposition", f'attachment; filename="{assignment}-results.json"')
        self.write("[")
        for index, hand_in in enumerate(counted):
            self.write(",\n" if index else "\n")
            self.write((store.folder(hand_in.number) / RESULT).read_bytes())
        self.finish("]\n")


@stream_request_body
class HandInHandler(HubUserHandler):
    """Receives answers. The body is read, up to the size limit, only after the hub has identified the student."""

    async def prepare(self) -> None:
        self._answer = bytearray()
        if not self.hub_auth.get_token(self, in_cookie=False):  # a page on another site could send a cookie
            raise Refused(403, "Hand in with a token of the hub in the header Authorization.")
        await super().prepare()
        self._require_size(int(self.request.headers.get("Content-Length", "0")))

    def data_received(self, chunk: bytes) -> None:
        self._require_size(len(self._answer) + len(chunk))
        self._answer += chunk

    def _require_size(self, size: int) -> None:
        if size > MAX_ANSWER:
            raise Refused(413, f"An answer has at most {MAX_ANSWER // 2**20} MiB.")

    async def put(self, assignment: str, key: str) -> None:
        """Store the answer, and acknowledge it when it is on the disk."""
        self.assignment(assignment)
        service, now = self.service, self.service.now()
        hand_in = service.store.with_key(self.student, key)
        if hand_in is None:
            service.require_try_left(self.student, assignment, now)
            if not self._answer:
                raise Refused(400, "The answer is empty.")
            try:
                hand_in = service.store.receive(self.student, assignment, key, bytes(self._answer), now)
            except sqlite3.Error:
                raise Refused(503, "The answer could not be stored. Nothing was handed in: try again.") from None
            await service.grader.notify()
        elif hand_in.assignment != assignment:
            raise Refused(409, "Another hand-in has this key.")
        self.set_status(HTTPStatus.CREATED)
        self.finish(
            {
                "number": hand_in.number,
                "handed_in": hand_in.at.isoformat(),
                "tries_left": service.tries_left(self.student, assignment, now),
                "page": f"{service.prefix}feedback/{hand_in.number}",
            }
        )

    def write_error(self, status_code: int, **more: Any) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps({"error": _sentence(status_code, more)}))


def _sentence(status_code: int, more: dict[str, Any]) -> str:
    error = more["exc_info"][1] if "exc_info" in more else None
    return error.sentence if isinstance(error, Refused) else f"{HTTPStatus(status_code).phrase}."
