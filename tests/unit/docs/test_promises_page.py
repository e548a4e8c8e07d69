"""Each promise of the README and of the guides has a test, and no test names words that are on no page."""

from __future__ import annotations

import runpy

import pytest

from autograder.course_paths import ROOT

SCRIPT = runpy.run_path(str(ROOT / "docs" / "promises_page.py"))
TEXTS = SCRIPT["texts"]()
PROMISES = list(SCRIPT["promises"]())


@pytest.mark.parametrize("page", TEXTS)
def test_each_promise_of_a_page_has_a_test(page: str) -> None:
    promised = [sentence for sentence in SCRIPT["sentences"](TEXTS[page]) if SCRIPT["is_promise"](sentence)]
    quoted = {promise.words for promise in PROMISES}
    untested = [sentence for sentence in promised if not any(words in sentence for words in quoted)]
    assert untested == [], "mark the test that shows it by @pytest.mark.promise, or say what is true"


def test_the_words_of_each_promise_occur_in_a_page() -> None:
    sentences = [sentence for text in TEXTS.values() for sentence in SCRIPT["sentences"](text)]
    assert [promise for promise in PROMISES if not any(promise.words in sentence for sentence in sentences)] == []


def test_promises_are_found() -> None:
    text = """# Title

Advice: run it. The exit status is 1. A node starts.

- `make demo` ends
  with a line. It is *never* silent.

| You see | `--resume` helps |

```console
$ cd folder
$ autograder grade class    # the class
```
"""
    assert [sentence for sentence in SCRIPT["sentences"](text) if SCRIPT["is_promise"](sentence)] == [
        "The exit status is 1.",
        "- `make demo` ends with a line.",
        "It is *never* silent.",
        "| You see | `--resume` helps |",
        "autograder grade class",
    ]


def test_the_page_marks_nightly_tests() -> None:
    page = SCRIPT["current"]()
    assert "`tests/e2e/test_tutorials.py::test_a_tutorial_runs_as_printed` (nightly)" in page
    assert "`tests/e2e/test_interrupt.py::test_ctrl_c_ends_a_class_and_resume_continues_it`" in page
