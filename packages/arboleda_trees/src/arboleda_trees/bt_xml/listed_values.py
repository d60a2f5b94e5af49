"""Values of a parameter of a tree, as the metadata `values` of its model list them."""

from __future__ import annotations

import re
from collections.abc import Iterable

from .findings import Findings
from .forest import Forest
from .target_groups import check_pairs, pairs

KEY = "values"
HOW = "a parameter with its values, `ml: 5, 10, 20`"
PAIR = re.compile(r"\s*([^\s:]+)\s*:\s*([^,]*[^\s,][^,]*(?:,[^,]*[^\s,][^,]*)*)")


def of_tree(forest: Forest, tree: str) -> dict[str, tuple[str, ...]]:
    """The values by parameter; a part that cannot be read is left out, `check` reports it."""
    rows = pairs(forest, tree, KEY, PAIR)
    return {name: tuple(each.strip() for each in listed.split(",")) for name, listed in rows}


def check(forest: Forest, findings: Findings) -> None:
    """Keep a finding for each part that cannot be read, or that names no parameter of its tree."""
    check_pairs(forest, findings, KEY, PAIR, HOW)


def can_be_listed(words: Iterable[str]) -> bool:
    """True if all of these words can stand in the list."""
    return all(word and word == word.strip() and not set(word) & set(",;") for word in words)
