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


def test_the_page_marks_nightly_tests_and_the_command_that_runs_a_promises_test() -> None:
    page = SCRIPT["current"]()
    assert "`tests/e2e/test_tutorials.py::test_a_tutorial_runs_as_printed` (nightly) | `make tutorials` |" in page
    assert "`tests/e2e/test_interrupt.py::test_ctrl_c_ends_a_class_and_resume_continues_it` | `make test` |" in page


def test_make_test_verifies_every_promise_except_those_of_these_tests() -> None:
    """A promise gets a test in `make test`, or its nightly test is listed here, and its file with the reason."""
    assert SCRIPT["nightly_only"]() == {
        "tests/e2e/test_hub_guide.py::test_the_commands_of_the_guide_make_a_hub_for_a_class",
        "tests/e2e/test_image.py::test_a_hub_starts_a_server_in_the_image",
        "tests/e2e/test_image.py::test_a_reference_answer_passes_the_check_in_the_image",
        "tests/e2e/test_image.py::test_gradescopes_autograder_grades_in_a_root_that_its_own_script_has_set_up",
        "tests/e2e/test_image.py::test_the_doctor_finds_nothing_missing_in_the_image",
        "tests/e2e/test_public_packages.py::test_colcon_runs_the_tests_of_each_package",
        "tests/e2e/test_public_packages.py::test_two_public_programs_exchange_messages",
        "tests/e2e/test_tutorials.py::test_a_tutorial_runs_as_printed",
    }


def test_each_file_with_the_only_test_of_a_promise_has_a_reason() -> None:
    assert {test.partition("::")[0] for test in SCRIPT["nightly_only"]()} == {*SCRIPT["NIGHTLY_ONLY"]}
