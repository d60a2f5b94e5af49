"""All trees as XML that stand anywhere in the repository: in files, in tests, on pages."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path

from arboleda_make.editing.errors import EditError
from arboleda_make.editing.tree_text import TreeText

HERE = Path(__file__).parents[5]
RULES = HERE / "packages/arboleda_trees/tests/fast/bt_xml"
WHERE = (
    *("examples/**/*.xml", "tests/**/*.py", "packages/*/tests/**/*.py", "docs/**/*.md", "tools/fuzz-trees"),
    "tests/**/*.xml",
)
FILE = re.compile(r"(?:<\?xml[^>]*>\s*)?<root\b.*?</root>\n?", re.DOTALL)


@cache
def texts() -> tuple[str, ...]:
    """The texts that can be read and have a tree."""
    files = [each for pattern in WHERE for each in sorted(HERE.glob(pattern))]
    found = dict.fromkeys(match for each in files for match in FILE.findall(each.read_text()))
    return tuple(each for each in [*found, *_of_rules()] if _has_nodes(each))


def _of_rules() -> list[str]:
    """The trees that the rules of BehaviorTree.CPP were computed with, a file each."""
    lines = [line for each in sorted(RULES.glob("rules*.txt")) for line in each.read_text().splitlines()]
    return [f'<root BTCPP_format="4">{line}</root>' for line in lines if line.startswith("<BehaviorTree")]


def _has_nodes(text: str) -> bool:
    try:
        return any(tree.children for tree in TreeText(text).trees.values())
    except EditError:
        return False  # what a test has on purpose
