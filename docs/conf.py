"""Settings of Sphinx for the site, which `docs/build_site.py` builds."""

from __future__ import annotations

import os
from typing import Any

from sphinx.application import Sphinx

project = "Building ROS 2 packages with Python"
author = "The authors of the course"
copyright = f"{author}, Apache License 2.0"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx_copybutton", "sphinxext.opengraph"]
# Pages include the first four, and link to the notebooks.
exclude_patterns = ["made", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md", "notebooks"]

html_theme = "furo"
html_title = "ROS 2 packages with Python"
html_favicon = "_static/icon.svg"
html_baseurl = os.environ.get("SITE_ADDRESS", "")  # the address of the site, which ends with a slash
html_static_path = ["_static"]
html_extra_path = ["_extra"]
html_css_files = ["site.css"]
# The contrast of Furo's own code colours is below WCAG 2, level AA.
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"

myst_heading_anchors = 3  # as on GitHub
myst_enable_extensions = ["deflist"]

# The copy button copies code without its output, and commands without their prompts.
copybutton_selector = "div:not(.output) > div.highlight > pre"
copybutton_prompt_text = "$ "

ogp_site_url = html_baseurl
ogp_image = "preview.png"  # docs/build_site.py draws it
ogp_image_alt = "A simulated robot has found its way through a lab by its lidar."

nb_execution_mode = "off"  # `make docs` has executed the notebooks
nb_merge_streams = True
# A %%writefile cell may contain XML or other text, which is then shown without colours.
suppress_warnings = ["misc.highlighting_failure"]

autodoc_member_order = "bysource"
default_role = "code"  # for `names` in docstrings
napoleon_use_ivar = True  # one line for each attribute


def fix_accessibility(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Give navigation captions a heading level, and make code and wide tables reachable by keyboard."""
    if "furo_navigation_tree" in context:
        context["furo_navigation_tree"] = context["furo_navigation_tree"].replace(
            'role="heading"', 'role="heading" aria-level="2"'
        )
    if "body" in context:
        body = context["body"].replace("<pre>", '<pre tabindex="0">')
        context["body"] = body.replace('<div class="table-wrapper', '<div tabindex="0" class="table-wrapper')


def keep_first_colon(app: Sphinx, kind: str, name: str, subject: object, options: object, lines: list[str]) -> None:
    """Begin a property's docstring with an empty comment. Otherwise, napoleon reads text before a colon as a type."""
    if kind in ("property", "attribute"):
        lines[:0] = ["..", ""]


def setup(app: Sphinx) -> None:
    """Let `keep_first_colon` run before napoleon, and `fix_accessibility` after the theme."""
    app.connect("autodoc-process-docstring", keep_first_colon, priority=400)
    app.connect("html-page-context", fix_accessibility, priority=900)
