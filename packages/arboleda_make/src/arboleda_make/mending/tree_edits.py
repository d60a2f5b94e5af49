"""Candidates in trees as XML: a step that is missing, before or behind a node that stands for one step."""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from xml.sax.saxutils import quoteattr

from arboleda.drivers import shown
from arboleda.model.plant_model import Cell
from arboleda.plant_check.mend import Cut

from .candidate import Candidate
from .clues import Clues, words_of
from .steps import BEFORE, KnownStep, steps_of

LEAF = re.compile(r"(?P<indent>\n[ \t]*)?(?P<node><(?P<kind>[A-Za-z_]\w*)\b[^<>]*/>)")
NO_STEPS = ("input_port", "output_port", "inout_port", "include", "SubTree", "Metadata")


def tree_candidates(file: str, text: str, cells: Sequence[Cell], clues: Clues) -> Iterator[Candidate]:
    """The candidates in a file of trees."""
    leaves = [each for each in LEAF.finditer(text) if each["kind"] not in NO_STEPS]
    for cell in cells:
        for step in steps_of(cell, clues, ""):
            node = _node(step)
            for number, leaf in enumerate(leaves if node and step.score > 0 else ()):
                near = step.score + min(3, clues.count(words_of(leaf["node"].replace("_", " "))))
                start, end = leaf.span("node")
                near += 3 * (clues.first.file == file and clues.first.line == text.count("\n", 0, start) + 1)
                yield Candidate(
                    cuts=(Cut(file=file, start=start, end=start, new=f"{node}{leaf['indent'] or ''}"),),
                    sentence=f"{node} before {leaf['node']}",
                    score=near + 2 * clues.says(*BEFORE),
                )
                yield Candidate(
                    cuts=(Cut(file=file, start=end, end=end, new=f"{leaf['indent'] or ''}{node}"),),
                    sentence=f"{node} behind {leaf['node']}",
                    score=near + 2 * clues.says("ends with") + number / 100,
                )


def _node(step: KnownStep) -> str:
    """A step as a node; empty where its values are not known."""
    if step.arguments and not step.values:
        return ""
    attributes = "".join(f" {name}={quoteattr(shown(value))}" for name, value in step.values)
    return f"<{step.role}_{step.verb}{attributes}/>"
