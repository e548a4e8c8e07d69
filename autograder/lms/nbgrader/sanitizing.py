"""Renders students' Markdown safely. nbgrader's templates would keep any HTML in it.

A page with it runs no script of a student's, and asks no host for anything: images come from beside the notebook, and
what MathJax could load, or put into the page, stays text. A link is followed only by a person who clicks it.
"""

from __future__ import annotations

import re
from typing import Any

from jinja2.runtime import Context
from jinja2.utils import pass_context
from nbconvert.filters import markdown2html
from nbconvert.preprocessors.sanitize import SanitizeHTML

TAGS = """
    a abbr b blockquote br caption cite code col colgroup dd del details dfn div dl dt em figcaption figure h1 h2 h3 h4
    h5 h6 hr i img kbd li ol p pre q s samp small span strong sub summary sup table tbody td tfoot th thead tr u ul var
"""
EVERYWHERE = ("class", "id", "title")
# A path below the notebook's folder. It has no scheme, host, query or `..`, and nothing that a browser would remove.
_BESIDE = re.compile(r"(?!\.)[\w-][\w.-]*(?:/(?!\.)[\w-][\w.-]*)*", re.ASCII)
# TeX by which MathJax loads extensions, styles and links, and `\csname`, which can spell any of it.
_TEX = re.compile(r"\\(?=\s*(?:style|href|require|class|cssId|csname|unicode|includegraphics|url|data|html|mml))")


def _image(tag: str, name: str, value: str) -> bool:
    return name in (*EVERYWHERE, "alt", "width", "height") or (name == "src" and bool(_BESIDE.fullmatch(value)))


ATTRIBUTES = {
    "*": list(EVERYWHERE),
    "a": ["href"],
    "img": _image,
    "td": ["align", "colspan", "rowspan"],
    "th": ["align", "colspan", "rowspan", "scope"],
}
# Links are http, https or mailto, or relative.
_SANITIZER: Any = SanitizeHTML(tags=TAGS.split(), attributes=ATTRIBUTES)  # type: ignore[no-untyped-call]


@pass_context
def sanitized_markdown(context: Context, source: str) -> str:
    """Return Markdown as HTML. Tags for scripts, frames and styles are escaped, and images of other hosts left out."""
    html = _TEX.sub("\\\\\u200b", markdown2html(source))  # an unseen character, with which it is no command
    return str(_SANITIZER.sanitize_html_tags(html))
