"""Renders the pages from the templates. All text is escaped. A page loads no other files.

The content security policy of a page lists the digest of each script that may run: the player, or the table sorter.
"""

from __future__ import annotations

import base64
import hashlib
from functools import cache
from html import escape
from pathlib import Path
from urllib.parse import urlsplit

import jinja2
from markupsafe import Markup

from autograder import course_paths
from autograder.plain_text import clean
from autograder.report.feedback.model import page_view
from autograder.report.feedback.pictures import Picture
from autograder.report.feedback.text import no_mark, number
from autograder.result.causes import FAILED_AS_WELL
from autograder.result.model import Result, write_atomically
from autograder.suite.contract import contract

TEMPLATES = course_paths.ROOT / "assets" / "templates"
PAGE = "feedback.html"


@cache
def environment() -> jinja2.Environment:
    """Return the template environment. It escapes all text and raises an exception for an unknown name."""

    def presentable(value: object) -> object:
        return clean(value) if isinstance(value, str) and not isinstance(value, Markup) else value

    templates = jinja2.Environment(
        loader=jinja2.FileSystemLoader(TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        finalize=presentable,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    templates.filters["number"] = number
    templates.filters["player"] = _player
    templates.filters["web_address"] = _web_address
    templates.globals["no_mark"] = no_mark
    templates.globals["failed_as_well"] = FAILED_AS_WELL
    templates.globals["style"] = Markup((TEMPLATES / "report.css").read_text(encoding="utf-8"))
    return templates


def digest(script: str) -> str:
    """Return the digest of a script for a page's content security policy, which blocks all other scripts."""
    return base64.b64encode(hashlib.sha256(script.encode("utf-8")).digest()).decode("ascii")


def write_page(path: Path, template: str, **values: object) -> Path:
    """Write a page from its template and return its path."""
    write_atomically(path, environment().get_template(template).render(**values).encode("utf-8"))
    return path


def write(result: Result, folder: Path, *, artifacts: Path | None = None) -> Path:
    """Write the feedback page of one submission and return its path.

    Args:
        result: the result to show.
        folder: the folder for `feedback.html`.
        artifacts: the folder of the result's pictures; None means `folder`.

    Raises:
        UsageError: the path of an artifact is outside of its folder.
    """
    requirements = contract(result.assignment) if result.assignment in course_paths.assignments() else {}
    page = page_view(result, artifacts or folder, requirements)
    script, style = _player_assets() if page.has_player else ("", "")
    return write_page(
        folder / PAGE,
        "feedback.html.j2",
        page=page,
        script=Markup(script),
        script_digest=digest(script),
        player_style=Markup(style),
    )


def _web_address(address: str | None) -> str | None:
    """Return `address` if it is an http or https address, and None otherwise."""
    return address if urlsplit(address or "").scheme in ("http", "https") else None


def _player_assets() -> tuple[str, str]:
    """Return the player's script and style sheet."""
    from sim.view import player  # it imports matplotlib, which is slow, and most pages have no run

    return player.SCRIPT, player.style()


def _player(picture: Picture, first: bool = False) -> Markup:
    """Return the player of a picture's run. A link to a time that does not name a run refers to the first player."""
    from sim.view import player

    alt = escape(clean(picture.caption), quote=True)
    still = f'<img class="run-still" src="{picture.uri}" alt="{alt}">' if picture.uri else ""
    options = {"id": f"run-{picture.name}", "data-theme": "auto", **({"data-first": "yes"} if first else {})}
    return Markup(player.markup(picture.run or "", still, **options))
