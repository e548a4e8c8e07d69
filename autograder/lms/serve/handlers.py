"""The addresses of the service, below its prefix on the hub. Only the hub authenticates users.

    GET  ./                               one's own hand-ins
    GET  ./feedback/NUMBER                the page of one; 403 for another student's
    GET  ./class/ASSIGNMENT               the class, for instructors
    GET  ./class/ASSIGNMENT/results.json  its results that count, for `autograder export`
    POST ./class/ASSIGNMENT/regrade       lets all that the class handed in be graded again
    PUT  ./hand-ins/ASSIGNMENT/KEY        hands in the body, by a token of the hub's

The same key again is the same hand-in: a client that got no answer can ask again.
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
from autograder.lms.serve.hand_in import HandIn, counting
from autograder.lms.serve.settings import AssignmentSettings, Shown
from autograder.lms.serve.shared import Refused, Service
from autograder.notebook.handing_in import MAX_ANSWER

KEY = r"[0-9a-f]{32}"  # of a hand-in, which its client draws


def application(service: Service, cookie_secret: bytes) -> Application:
    """Return the application that answers below the service's prefix, which begins and ends with a slash."""
    routes: list[tuple[str, type[RequestHandler]]] = [
        ("", Home),
        (r"feedback/([0-9]{1,9})", Feedback),
        (r"class/([^/]+)", Class),
        (r"class/([^/]+)/results\.json", Results),
        (r"class/([^/]+)/regrade", Regrade),
        (rf"hand-ins/([^/]+)/({KEY})", HandingIn),
        ("oauth_callback", HubOAuthCallbackHandler),
    ]
    return Application(
        [(service.prefix + path, handler) for path, handler in routes],
        service=service,
        cookie_secret=cookie_secret,
        default_handler_class=NotThere,
    )


class Known(HubOAuthenticated, RequestHandler):
    """A request of a user whom the hub knows; others are sent to the hub's login."""

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
            async with self.service.asking:
                await self.hub_auth.get_user(self, sync=False)  # kept for current_user, which would hold up all others
        except HTTPError:
            raise Refused(503, "The hub does not say who you are. Try again.") from None
        user = self.current_user
        if user is None and self.request.method in ("GET", "HEAD"):
            self.redirect(self.get_login_url())
            return
        if user is None or user["kind"] != "user":
            raise Refused(403, "Log in to the hub: its token was not accepted here.")
        self.student = user["name"]

    def write_error(self, status_code: int, **more: Any) -> None:
        """Answer with the sentence of the error; a fault of the service's own has only its name."""
        self.set_header("Content-Type", "text/html; charset=utf-8")
        self.finish(pages.error(status_code, _sentence(status_code, more)))

    @property
    def teaches(self) -> bool:
        """Whether an instructor asks."""
        return self.student in self.service.settings.instructors

    def assignment(self, name: str) -> AssignmentSettings:
        """Return the settings of an assignment that a request names."""
        settings = self.service.settings.assignments.get(name)
        if settings is None:
            raise Refused(404, "There is no such assignment here.")
        return settings

    def require_instructor(self) -> None:
        """Refuse all others."""
        if not self.teaches:
            raise Refused(403, "This page is for instructors.")

    def places(self, own: list[HandIn]) -> dict[int, pages.Place]:
        """Return the positions of the waiting hand-ins in the queue."""
        grader = self.service.grader
        return {
            one.number: pages.Place(graded_now, 0 if graded_now else grader.ahead_of(one.number))
            for one in own
            if one.mark is None
            for graded_now in (grader.is_graded_now(one.number),)
        }


class NotThere(Known):
    """An unknown address."""

    async def prepare(self) -> None:
        raise Refused(404, "There is no such page.")


class Home(Known):
    """A student's own hand-ins."""

    def get(self) -> None:
        """Show them."""
        service, own = self.service, self.service.store.of_student(self.student)
        sections = pages.sections(service.settings, own, self.places(own), self.student, service.now())
        zone = str(service.settings.zone)
        self.finish(pages.home(self.student, sections, teaches=self.teaches, prefix=service.prefix, zone=zone))


class Feedback(Known):
    """The page of one hand-in."""

    def get(self, number: str) -> None:
        """Show it to its student, as far as the settings say, and to instructors."""
        hand_in = self.service.store.with_number(int(number))
        if hand_in is None:
            raise Refused(404, "There is no such hand-in.")
        if hand_in.student != self.student and not self.teaches:
            raise Refused(403, "This is another student's feedback.")
        if hand_in.mark is None:
            self.finish(pages.state(hand_in, self.places([hand_in])[hand_in.number].words))
            return
        each = self.service.settings.assignments.get(hand_in.assignment, AssignmentSettings())
        shown = Shown.EVERYTHING if self.teaches else each.shown_to(self.student, self.service.now())
        self.finish(pages.feedback(hand_in, self.service.store.folder(hand_in.number), shown))


class Class(Known):
    """The page of a class."""

    def get(self, assignment: str) -> None:
        """Show it to instructors."""
        self.require_instructor()
        self.assignment(assignment)
        store = self.service.store
        hand_ins, waiting, form = store.of_assignment(assignment), len(store.waiting()), self.xsrf_form_html()
        self.finish(pages.class_page(self.service.settings, assignment, hand_ins, waiting, self.service.prefix, form))


class Regrade(Known):
    """Grades a class again, for example after a check was fixed."""

    async def post(self, assignment: str) -> None:
        """Let each graded answer wait again. The hub's library has checked that a page of the service sent the form."""
        self.require_instructor()
        self.assignment(assignment)
        self.service.store.grade_again(assignment)
        await self.service.grader.notify()
        self.redirect(f"{self.service.prefix}class/{assignment}")


class Results(Known):
    """The results of a class that count."""

    def get(self, assignment: str) -> None:
        """Send them to instructors as `autograder export` reads them."""
        self.require_instructor()
        best, store = self.assignment(assignment).best_counts, self.service.store
        by_student: dict[str, list[HandIn]] = {}
        for one in store.of_assignment(assignment):
            by_student.setdefault(one.student, []).append(one)
        counted = filter(None, (counting(own, best=best) for own in by_student.values()))
        self.set_header("Content-Type", "application/json")
        self.set_header("Content-Disposition", f'attachment; filename="{assignment}-results.json"')
        self.write("[")
        for place, one in enumerate(counted):
            self.write(",\n" if place else "\n")
            self.write((store.folder(one.number) / RESULT).read_bytes())
        self.finish("]\n")


@stream_request_body
class HandingIn(Known):
    """Takes an answer. The body is read once the hub has said whose it is, up to the bound."""

    async def prepare(self) -> None:
        self._answer = bytearray()
        if not self.hub_auth.get_token(self, in_cookie=False):  # a page elsewhere could send a cookie
            raise Refused(403, "Hand in with a token of the hub in the header Authorization.")
        await super().prepare()
        self._require_bound(int(self.request.headers.get("Content-Length", "0")))

    def data_received(self, chunk: bytes) -> None:
        self._require_bound(len(self._answer) + len(chunk))
        self._answer += chunk

    def _require_bound(self, size: int) -> None:
        if size > MAX_ANSWER:
            raise Refused(413, f"An answer has at most {MAX_ANSWER // 2**20} MiB.")

    async def put(self, assignment: str, key: str) -> None:
        """Keep the answer, and acknowledge it once it is on the disk."""
        self.assignment(assignment)
        service, now = self.service, self.service.now()
        known = service.store.with_key(self.student, key)
        if known is None:
            service.require_a_try(self.student, assignment, now)
            if not self._answer:
                raise Refused(400, "The answer is empty.")
            try:
                known = service.store.receive(self.student, assignment, key, bytes(self._answer), now)
            except sqlite3.Error:
                raise Refused(503, "The answer could not be kept. Nothing was handed in: try again.") from None
            await service.grader.notify()
        elif known.assignment != assignment:
            raise Refused(409, "This key is that of another hand-in.")
        self.set_status(HTTPStatus.CREATED)
        self.finish(
            {
                "number": known.number,
                "handed_in": known.at.isoformat(),
                "tries_left": service.tries_left(self.student, assignment, now),
                "page": f"{service.prefix}feedback/{known.number}",
            }
        )

    def write_error(self, status_code: int, **more: Any) -> None:
        self.set_header("Content-Type", "application/json")
        self.finish(json.dumps({"error": _sentence(status_code, more)}))


def _sentence(status_code: int, more: dict[str, Any]) -> str:
    error = more["exc_info"][1] if "exc_info" in more else None
    return error.sentence if isinstance(error, Refused) else f"{HTTPStatus(status_code).phrase}."
