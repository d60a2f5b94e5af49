"""The part of `arboleda tree` that is about files of trees."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from arboleda.cli.language import allowed
from arboleda.extension import ConfigError, Phrase, say

from ..bt_xml import rows as tree_rows
from ..files.tree_file import load

WHICH_TREE = Phrase("cli.tree.which", '{file}: which tree? <root main_tree_to_execute="...">; {others}')


def rows_of(path: Path) -> list[dict[str, Any]]:
    """The tree that a file of trees names as its main one, or its only one."""
    forest = load(path).forest
    if forest.main is None:
        raise ConfigError((say(WHICH_TREE(file=str(path), others=allowed("", forest.trees))),))
    return tree_rows.rows(forest, forest.main)
