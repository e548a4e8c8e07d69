"""Generates the mutants of a chapter: applies each operator wherever it matches in the files that students write."""

from __future__ import annotations

import ast
import difflib
import hashlib
import itertools
from collections.abc import Iterator
from dataclasses import dataclass
from types import CodeType

from autograder import course_paths
from autograder.author.course.cells import copied_file, is_solution
from autograder.author.course.sync import Chapter
from autograder.author.verification.python_operators import (
    Mutation,
    Replacement,
    Source,
    classic_mutations,
    nodes_in_context,
    removal_mutations,
    replaced,
)
from autograder.author.verification.ros_operators import is_queue_length, multi_node_mutations, ros_mutations, wall_time
from autograder.author.verification.text_operators import text_mutations
from autograder.suite import suites

PAIRS = 20  # the maximum number of second-order mutants in a chapter


@dataclass(frozen=True)
class GeneratedMutant:
    """A mutant of the reference.

    Attributes:
        id: names the file, the function, the operator and a digest of the change. It is stable when other code changes.
        operator: the operator's name; "pair" for a second-order mutant.
        function: the qualified name of the changed function, or "".
        changes: the replacements in each file, whose path is relative to `solutions/`.
    """

    id: str
    operator: str
    function: str
    changes: tuple[tuple[str, tuple[Replacement, ...]], ...]

    @property
    def file(self) -> str:
        """The path of the first changed file."""
        return self.changes[0][0]

    def texts(self) -> dict[str, str]:
        """Return the new text of each changed file."""
        return {
            file: replaced((course_paths.SOLUTIONS / file).read_bytes(), changes).decode()
            for file, changes in self.changes
        }

    def diff(self) -> str:
        """Return the lines that differ, with their line numbers, in a readable form."""
        diff_lines: list[str] = []
        for file, text in self.texts().items():
            old, new = (course_paths.SOLUTIONS / file).read_text(encoding="utf-8").splitlines(), text.splitlines()
            matcher = difflib.SequenceMatcher(None, old, new, autojunk=False)
            for tag, first, end, new_start, new_end in matcher.get_opcodes():
                if tag != "equal":
                    diff_lines += [f"{file}:{first + 1}"]
                    diff_lines += [f"- {line.strip()}" for line in old[first:end]]
                    diff_lines += [f"+ {line.strip()}" for line in new[new_start:new_end]]
        return "\n".join(diff_lines)


@dataclass(frozen=True)
class GeneratedMutants:
    """A chapter's mutants, the second-order ones last, and how many were omitted as equivalents or duplicates."""

    mutants: tuple[GeneratedMutant, ...]
    omitted: int


def generated_mutants(assignment: str) -> GeneratedMutants:
    """Return the mutants of a chapter. They depend only on its reference."""
    mutants: dict[str, GeneratedMutant] = {}
    omitted_count = 0
    for file, functions, provided_lines in written_by_students(assignment):
        text = (course_paths.SOLUTIONS / file).read_text(encoding="utf-8")
        meanings = {_meaning_key(file, text)}
        for function, (operator, changes) in mutations(file, text, functions):
            if provided_lines.issuperset(_changed_lines(text.encode(), changes)):
                continue
            meaning = _meaning_key(file, replaced(text.encode(), changes).decode())
            if meaning in meanings:
                omitted_count += 1
                continue
            meanings.add(meaning)
            mutant = _make_mutant(file, function, operator, changes, text)
            assert mutant.id not in mutants, f"two mutants are called {mutant.id}"
            mutants[mutant.id] = mutant
    return GeneratedMutants((*mutants.values(), *_pairs(list(mutants.values()))), omitted_count)


def written_by_students(assignment: str) -> Iterator[tuple[str, frozenset[str] | None, frozenset[bytes]]]:
    """Yield (path, functions, provided lines) for each file that students write or correct.

    The functions are those that students write; None means all. The provided lines are the lines of the faulty version
    that students get.
    """
    packages, chapter = suites.hidden(assignment).sources, Chapter(course_paths.chapter(assignment))
    copies = [(cell, copy) for cell in chapter.read().cells if (copy := copied_file(cell))]
    for cell, copy in copies:
        if is_solution(cell) and copy.source.parts[0] in packages:
            yield str(copy.source), frozenset(copy.hidden_functions) or None, frozenset()
    source_folder = chapter.folder / "ws" / "src"
    written_packages = {copy.source.parts[0] for _, copy in copies}
    for package in set(packages) - written_packages:  # students get a faulty version and correct it
        for path in sorted((source_folder / package).rglob("*")):
            correct = course_paths.SOLUTIONS / path.relative_to(source_folder)
            if correct.is_file() and path.is_file() and correct.read_bytes() != path.read_bytes():
                yield str(path.relative_to(source_folder)), None, frozenset(path.read_bytes().splitlines())


def mutations(file: str, text: str, functions: frozenset[str] | None) -> Iterator[tuple[str, Mutation]]:
    """Yield (name of the changed function, mutation) for each mutation of a file."""
    if not file.endswith(".py"):
        yield from (("", mutation) for mutation in text_mutations(file, text))
        return
    source = Source(text)
    nodes: list[ast.AST] = []
    for function, context in nodes_in_context(source, functions):
        nodes.append(context.node)
        single_node = itertools.chain(
            () if is_queue_length(context) else classic_mutations(source, context.node), ros_mutations(source, context)
        )
        yield from ((function, (name, ((*source.span(node), new),))) for name, node, new in single_node)
        multi_node = itertools.chain(removal_mutations(source, context.node), multi_node_mutations(source, context))
        yield from ((function, mutation) for mutation in multi_node)
    yield from (("", mutation) for mutation in wall_time(source, nodes))


def _make_mutant(
    file: str, function: str, operator: str, changes: tuple[Replacement, ...], text: str
) -> GeneratedMutant:
    """Return a mutant whose id depends on the lines around its change, so that it stays the same when lines move."""
    data = text.encode()
    name_digest = hashlib.sha256(f"{file} {function} {operator}".encode())
    for start, end, new in changes:
        begin, stop = data.rfind(b"\n", 0, start) + 1, data.find(b"\n", end)
        before, old = data[begin:start], data[start:end]
        name_digest.update(b"\0".join((before, old, new.encode(), data[end:stop])))
        name_digest.update(data[:begin].count(data[begin:stop]).to_bytes(2, "big"))  # the same lines may occur twice
    target = ".".join(filter(None, (file.rpartition("/")[2], function)))
    return GeneratedMutant(f"{target} {operator} {name_digest.hexdigest()[:6]}", operator, function, ((file, changes),))


def _pairs(mutants: list[GeneratedMutant]) -> Iterator[GeneratedMutant]:
    """Yield second-order mutants: pseudo-random pairs of mutants whose changes do not overlap."""
    shuffled_mutants = sorted(mutants, key=lambda mutant: hashlib.sha256(mutant.id.encode()).digest())
    for first, second in itertools.islice(zip(shuffled_mutants[::2], shuffled_mutants[1::2], strict=False), PAIRS):
        changes = dict(first.changes)
        for file, replacements in second.changes:
            combined_replacements = sorted((*changes.get(file, ()), *replacements))
            if any(before[1] > after[0] for before, after in itertools.pairwise(combined_replacements)):
                break
            changes[file] = tuple(combined_replacements)
        else:
            yield GeneratedMutant(f"{first.id} + {second.id}", "pair", first.function, tuple(changes.items()))


def _changed_lines(data: bytes, changes: tuple[Replacement, ...]) -> Iterator[bytes]:
    """Yield the lines that contain replacements."""
    for start, end, _ in changes:
        last = start + len(data[start:end].rstrip())
        yield from data[data.rfind(b"\n", 0, start) + 1 : data.find(b"\n", last)].splitlines()


def _meaning_key(file: str, text: str) -> object:
    """Return a key that is equal for texts that the interpreter or the build treats alike."""
    if file.endswith(".py"):
        return _code_key(compile(text, file, "exec", optimize=0))
    return "\n".join(filter(None, (line.split("#")[0].strip() for line in text.splitlines())))


def _code_key(code: CodeType) -> tuple[object, ...]:
    constants = tuple(
        _code_key(constant) if isinstance(constant, CodeType) else (type(constant), repr(constant))
        for constant in code.co_consts
    )
    exception_table = getattr(code, "co_exceptiontable", b"")  # since Python 3.11
    return code.co_code, constants, code.co_names, code.co_varnames, exception_table
