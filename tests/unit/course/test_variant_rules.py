"""A file of a variant that has no effect is found."""

from __future__ import annotations

from pathlib import Path

import pytest

from autograder import course_paths
from autograder.author.course.variant_rules import variants_findings
from autograder.course_paths import Course
from autograder.suite import suites

NODE, OTHER = "guard/guard/node.py", "guard/guard/other_name.py"
TEXT = "def main():\n    pass\n"


@pytest.fixture
def variants(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of a chapter's variants, in a course with a small reference."""
    monkeypatch.setattr(course_paths, "course", lambda: Course(tmp_path, "small", "A small course"))
    write(tmp_path / "solutions", {NODE: TEXT, "guard/guard/__init__.py": ""})
    return tmp_path / "checks" / "ch01_small" / "variants"


def write(folder: Path, files: dict[str, str]) -> None:
    for name, text in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text)


def found(variants: Path, files: dict[str, str]) -> list[str]:
    write(variants / "loop", files)
    return [
        str(finding).removeprefix("checks/ch01_small/variants/loop")
        for finding in variants_findings(variants, ["guard"])
    ]


def test_a_file_that_replaces_one_of_the_reference_is_accepted(variants: Path) -> None:
    assert found(variants, {NODE: TEXT + "\n"}) == []


def test_a_misspelt_file_is_found_with_the_name_that_was_meant(variants: Path) -> None:
    sentence = "replaces no file of the reference, and no other file of the variant names `nod`: did you mean"
    assert found(variants, {"guard/guard/nod.py": TEXT}) == [f"/guard/guard/nod.py:1: {sentence} `{NODE}`?"]


def test_a_new_module_is_accepted_if_another_file_of_the_variant_imports_it(variants: Path) -> None:
    assert found(variants, {NODE: "from .other_name import main\n", OTHER: TEXT}) == []


def test_a_new_package_is_accepted_if_another_file_of_the_variant_imports_it(variants: Path) -> None:
    assert found(variants, {NODE: "from guard.parts import main\n", "guard/guard/parts/__init__.py": TEXT}) == []


def test_a_new_module_that_nothing_imports_is_found(variants: Path) -> None:
    (sentence,) = found(variants, {NODE: TEXT + "\n", "guard/a.txt": TEXT})
    assert sentence.endswith("names `a`: correct its path, or remove it")


def test_a_new_test_is_accepted_because_pytest_finds_it(variants: Path) -> None:
    assert found(variants, {"guard/test/test_more.py": TEXT, "guard/test/conftest.py": TEXT}) == []


def test_a_file_that_is_not_python_is_found_with_its_line(variants: Path) -> None:
    (sentence,) = found(variants, {NODE: "import os\ndef main(:\n"})
    assert sentence.startswith(f"/{NODE}:2: is not Python: ")


def test_a_variant_that_is_the_reference_is_found(variants: Path) -> None:
    assert found(variants, {NODE: TEXT}) == [
        ": has the same files as the reference: change one, or remove this variant"
    ]


def test_a_package_that_the_suite_does_not_grade_is_reported_once(variants: Path) -> None:
    assert found(variants, {NODE.replace("guard", "gard"): TEXT}) == [
        "/gard: `gard` is not a package of the suite: did you mean `guard`?"
    ]


@pytest.mark.parametrize("assignment", suites.graded_assignments())
def test_every_file_of_the_variants_of_the_course_is_used(assignment: str) -> None:
    suite = suites.hidden(assignment)
    assert [*variants_findings(suite.folder / "variants", suite.sources)] == []
