"""Settings of Sphinx for the site, which `docs/build_site.py` builds."""

from __future__ import annotations

from typing import Any

from sphinx.application import Sphinx

project = "Building ROS 2 packages with Python"
author = "The authors of the course"
copyright = f"{author}, Apache License 2.0"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
exclude_patterns = ["made", "CHANGELOG.md", "CONTRIBUTING.md", "SECURITY.md"]  # other pages include them

html_theme = "furo"
html_title = "ROS 2 packages with Python"
html_static_path = ["_static"]
html_extra_path = ["_extra"]
html_css_files = ["site.css"]
# Furo's own colours of code have less contrast than people with weak eyes need (WCAG 2, level AA).
pygments_style = "a11y-high-contrast-light"
pygments_dark_style = "a11y-high-contrast-dark"

myst_heading_anchors = 3  # as on GitHub
myst_enable_extensions = ["deflist"]

nb_execution_mode = "off"  # `make docs` executes the notebooks before
nb_merge_streams = True
# A cell after %%writefile may hold XML or text of another kind, and is shown without colours.
suppress_warnings = ["misc.highlighting_failure"]

autodoc_member_order = "bysource"


def fix_accessibility(app: Sphinx, page: str, template: str, context: dict[str, Any], doctree: object) -> None:
    """Give captions of the navigation a level, and let the keyboard reach code that is wider than its box."""
    if "furo_navigation_tree" in context:
        context["furo_navigation_tree"] = context["furo_navigation_tree"].replace(
            'role="heading"', 'role="heading" aria-level="2"'
        )
    if "body" in context:
        context["body"] = context["body"].replace("<pre>", '<pre tabindex="0">')


def setup(app: Sphinx) -> None:
    """Connect what this file adds, after the theme has made its part of a page."""
    app.connect("html-page-context", fix_accessibility, priority=900)
