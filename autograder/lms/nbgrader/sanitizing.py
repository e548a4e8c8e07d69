"""Renders students' Markdown safely. nbgrader's templates would keep any HTML in it.

The rendered page does not run scripts and sends no requests to other hosts. Images are loaded only from the notebook's
folder. TeX commands that make MathJax load or insert anything remain plain text. Links open only when they are clicked.
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
GLOBAL_ATTRIBUTES = ("class", "id", "title")
# A path below the notebook's folder, without a scheme, host, query, `..` or characters that a browser removes.
_RELATIVE_PATH = re.compile(r"(?!\.)[\w-][\w.-]*(?:/(?!\.)[\w-][\w.-]*)*", re.ASCII)
# TeX commands that load extensions, styles or links in MathJax, and `\csname`, which can form any of them.
_TEX = re.compile(r"\\(?=\s*(?:style|href|require|class|cssId|csname|unicode|includegraphics|url|data|html|mml))")


def _image(tag: str, name: str, value: str) -> bool:
    return name in (*GLOBAL_ATTRIBUTES, "alt", "width", "height") or (
        name == "src" and bool(_RELATIVE_PATH.fullmatch(value))
    )


ATTRIBUTES = {
    "*": list(GLOBAL_ATTRIBUTES),
    "a": ["href"],
    "img": _image,
    "td": ["align", "colspan", "rowspan"],
    "th": ["align", "colspan", "rowspan", "scope"],
}
# Links may be http, https, mailto or relative.
_SANITIZER: Any = SanitizeHTML(tags=TAGS.split(), attributes=ATTRIBUTES)  # type: ignore[no-untyped-call]


@pass_context
def sanitized_markdown(context: Context, source: str) -> str:
    """Render Markdown as HTML. Tags for scripts, frames and styles are escaped, and images from other hosts removed."""
    html = _TEX.sub("\\\\\u200b", markdown2html(source))  # an invisible character that disables the command
    return str(_SANITIZER.sanitize_html_tags(html))
