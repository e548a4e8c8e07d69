"""Renders students' Markdown safely. nbgrader's templates would keep any HTML in it."""

from __future__ import annotations

from typing import Any

from jinja2.runtime import Context
from jinja2.utils import pass_context
from nbconvert.filters import markdown2html
from nbconvert.preprocessors.sanitize import SanitizeHTML

TAGS = """
    a abbr b blockquote br caption cite code col colgroup dd del details dfn div dl dt em figcaption figure h1 h2 h3 h4
    h5 h6 hr i img kbd li ol p pre q s samp small span strong sub summary sup table tbody td tfoot th thead tr u ul var
"""
ATTRIBUTES = {
    "*": ["class", "id", "title"],
    "a": ["href"],
    "img": ["src", "alt", "width", "height"],
    "td": ["align", "colspan", "rowspan"],
    "th": ["align", "colspan", "rowspan", "scope"],
}
# Links are http, https or mailto, or relative.
_SANITIZER: Any = SanitizeHTML(tags=TAGS.split(), attributes=ATTRIBUTES)  # type: ignore[no-untyped-call]


@pass_context
def sanitized_markdown(context: Context, source: str) -> str:
    """Return Markdown as HTML. Tags for scripts, frames and styles are escaped."""
    return str(_SANITIZER.sanitize_html_tags(markdown2html(source)))
