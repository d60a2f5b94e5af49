"""Candidates in recipes in Python: a step that is missing, stands elsewhere, or is written otherwise."""

from __future__ import annotations

import ast
from collections.abc import Iterator, Sequence

from arboleda.model.plant_model import Cell
from arboleda.plant_check.mend import Cut

from .candidate import Candidate
from .clues import Clues, words_of
from .python_source import Element, PythonSource, called
from .steps import BEFORE, KnownStep, steps_of

AT_END = ("ends with", "is called done")
INSIDE = (" leave ", "holds", " part", "seat", "ends with")
MOVED = ("while", "no part to work on", "stands at no target", "needs", "take hold", "lets go", "leave")
MISPLACED = ("while", "no part to work on", "stands at no target")
AT_ONCE = ("at once", "two branches")
NOT_ASKED, NO_WAY, ENDLESS = "which is not asked by then", "has no way for", "never ends so"
TRIED = 3  # times that something is tried again, where it was without a limit


def python_candidates(source: PythonSource, cells: Sequence[Cell], clues: Clues) -> Iterator[Candidate]:
    """The candidates in a file."""
    yield from _other_calls(source, clues)
    yield from _choices(source, clues)
    yield from _limits(source, clues)
    yield from _other_devices(source, clues)
    yield from _moves(source, clues)
    for cell in cells:
        for step in steps_of(cell, clues, source.text):
            if step.score > 0 or step.handles:
                yield from _insertions(source, clues, step)


def _insertions(source: PythonSource, clues: Clues, step: KnownStep) -> Iterator[Candidate]:
    for number, element in enumerate(source.elements):
        handle = source.handle_of(step.role, element.function)
        if handle is None:
            continue
        words = f"{handle}.{step.verb}({step.arguments})"
        near, text = _near(source, clues, element), source.source(element.node)
        score = step.score + near
        own = clues.count({element.function.name}) * 0.5
        yield Candidate(
            cuts=source.before(element, words),
            sentence=f"{step.words} before {_short(text)}",
            score=score + own + 2 * clues.says(*BEFORE),
        )
        if not element.siblings or element.number == len(element.siblings) - 1:
            yield Candidate(
                cuts=source.after(element, words),
                sentence=f"{step.words} behind {_short(text)}",
                score=score
                + own
                + 2 * clues.says(*AT_END) * (called(element.parent) != "visit")
                + number / 100,
            )
        if isinstance(element.node, ast.Call) and called(element.node) == "visit":
            bare = step.handles * 2 * (len(element.node.args) == 1)
            for first in (False, True)[: 1 + (len(element.node.args) > 1)]:
                yield Candidate(
                    cuts=source.inside(element.node, words, first=first),
                    sentence=f"{step.words} within {_short(text)}",
                    score=score + own + bare + step.handles + clues.says(*INSIDE) - 0.2 * first,
                )


def _near(source: PythonSource, clues: Clues, element: Element) -> float:
    """The nearness of an element to the findings: the number of its names in them, at most 3."""
    return min(3, clues.count(words_of(source.source(element.node)))) if _is_small(element) else 0.3


def _is_small(element: Element) -> bool:
    return called(element.node) not in ("work", "parallel", "choose", "using")


def _moves(source: PythonSource, clues: Clues) -> Iterator[Candidate]:
    if not clues.says(*MOVED):
        return
    for element in source.elements:
        if not element.siblings or not _is_small(element) or not isinstance(element.node, ast.Call):
            continue
        near = clues.count(words_of(source.source(element.node)))
        if near:
            for cuts, where in _elsewhere(source, element):
                text = _short(source.source(element.node))
                score = min(near, 3) + (5.5 if clues.says(*MISPLACED) else 2.5)
                yield Candidate(cuts=cuts, sentence=f"{text} {where}", score=score)


def _elsewhere(source: PythonSource, element: Element) -> Iterator[tuple[tuple[Cut, ...], str]]:
    """The places beside an element to which it can go: out of a visit, into one, past a neighbour."""
    text, cut = source.source(element.node), source.without(element)
    siblings, number = element.siblings, element.number
    if called(element.parent) == "visit":
        outer = next((each for each in source.elements if each.node is element.parent), None)
        if outer is not None:
            whole = _short(source.source(outer.node))
            yield (*cut, *source.after(outer, text)), f"behind {whole}"
            yield (*cut, *source.before(outer, text)), f"before {whole}"
    if len(siblings) < 2:
        return
    for other in (number + 1, number - 1):
        if not 0 <= other < len(siblings):
            continue
        beside = siblings[other]
        name = _short(source.source(beside))
        if isinstance(beside, ast.Call) and called(beside) == "visit":
            yield (*cut, *source.inside(beside, text)), f"at the end of {name}"
        swapped = (
            source.cut(source.start(element.node), source.end(element.node), source.source(beside)),
            source.cut(source.start(beside), source.end(beside), text),
        )
        yield swapped, f"{'behind' if other > number else 'before'} {name}"


def _other_calls(source: PythonSource, clues: Clues) -> Iterator[Candidate]:
    """One after the other, in place of at once."""
    if clues.says(*AT_ONCE):
        for node in ast.walk(source.tree):
            if isinstance(node, ast.Call) and called(node) == "parallel":
                cut = source.cut(source.start(node.func), source.end(node.func), "work")
                near = clues.count(words_of(source.source(node)))
                yield Candidate(cuts=(cut,), sentence="work(...) in place of parallel(...)", score=6 + near)


def _choices(source: PythonSource, clues: Clues) -> Iterator[Candidate]:
    """A question before the choice by its answer; a way for each answer."""
    for element in source.elements:
        if clues.says(NOT_ASKED) and called(element.node) == "choose":
            assert isinstance(element.node, ast.Call)
            question = source.source(element.node.args[0])
            yield Candidate(
                cuts=source.before(element, question),
                sentence=f"{question} before {_short(source.source(element.node))}",
                score=6,
            )
    if not clues.says(NO_WAY):
        return
    for function in source.functions:
        for node in ast.walk(function):
            if isinstance(node, ast.Dict) and node.values and function.args.args:
                cell, at = function.args.args[0].arg, source.end(node.values[-1])
                for word in clues.quoted:
                    way = f'"{word}": {cell}.fail("{word}")'
                    yield Candidate(
                        cuts=(source.cut(at, at, f", {way}"),),
                        sentence=f"the way {way}",
                        score=6 + clues.count(words_of(source.source(node))) / 10,
                    )


def _limits(source: PythonSource, clues: Clues) -> Iterator[Candidate]:
    if not clues.says(ENDLESS):
        return
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Constant) and type(node.value) is int and node.value in clues.numbers:
            cut = source.cut(source.start(node), source.end(node), str(TRIED))
            yield Candidate(cuts=(cut,), sentence=f"{TRIED} in place of {node.value:,}", score=6)


def _other_devices(source: PythonSource, clues: Clues) -> Iterator[Candidate]:
    """Another device of a function in the line of a problem, in place of the one that has no such target."""
    line = clues.first.line
    for function in source.functions if clues.says("has no target") else ():
        names = list(source.handles(function))
        for wrong in [each for each in names if each in words_of(clues.first.sentence)]:
            at = [
                each
                for each in ast.walk(function)
                if isinstance(each, ast.Name) and each.id == wrong and each.lineno == line
            ]
            for right in [each for each in names if each != wrong and at]:
                cuts = tuple(source.cut(source.start(each), source.end(each), right) for each in at)
                yield Candidate(cuts=cuts, sentence=f"{right} in place of {wrong}", score=5)


def _short(text: str) -> str:
    line = " ".join(text.split())
    return line if len(line) <= 60 else f"{line[:57]}..."
