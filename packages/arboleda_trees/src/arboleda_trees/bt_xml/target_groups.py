"""Groups of targets for the parameters of a tree, as the metadata `targets` of its model list them."""

from __future__ import annotations

import re
from collections.abc import Iterator

from arboleda.drivers import among, quoted
from arboleda.model.plant_model import Cell

from .findings import Findings
from .forest import Forest, Metadata
from .nodes import PortDirection

KEY = "targets"
HOW = "a parameter with a group of targets, `blank: pallet`"
PAIR = re.compile(r"\s*([^\s:]+)\s*:\s*([^\s:]+)\s*")


def of_tree(forest: Forest, tree: str) -> dict[str, str]:
    """The groups by parameter; a part that cannot be read is left out, `check` reports it."""
    return dict(pairs(forest, tree, KEY, PAIR))


def pairs(forest: Forest, tree: str, key: str, form: re.Pattern[str]) -> Iterator[tuple[str, str]]:
    """The parameters of a tree with their values in the metadata of this key, as far as they can be read."""
    matches = (form.fullmatch(text) for each in forest.metadata_of(tree, key) for text in _parts(each))
    return ((pair[1], pair[2]) for pair in matches if pair is not None)


def words(cell: Cell, group: str) -> list[str]:
    """The targets of a group of a cell, in their order; without such a group, the target of this name."""
    return list(cell.groups.get(group) or [each for each in cell.targets if each == group])


def check(forest: Forest, findings: Findings) -> None:
    """Keep a finding for each part that cannot be read, or that names no parameter of its tree."""
    check_pairs(forest, findings, KEY, PAIR, HOW)


def check_pairs(forest: Forest, findings: Findings, key: str, form: re.Pattern[str], how: str) -> None:
    """Keep a finding for each part of the metadata of this key without this form, or without a parameter."""
    for tree in forest.metadata:
        ports = forest.declared_ports(tree).values()
        names = [each.name for each in ports if each.direction is PortDirection.IN]
        for metadata in forest.metadata_of(tree, key):
            for text in _parts(metadata):
                pair = form.fullmatch(text)
                if pair is None:
                    sentence = f"{key} of {tree}: {quoted(text.strip())} is not read; write {how}"
                    findings.mistake(metadata.place, sentence)
                elif pair[1] not in names:
                    allowed = among(pair[1], names) if names else "it has no parameter"
                    findings.mistake(metadata.place, f"{key} of {tree} names {quoted(pair[1])}; {allowed}")


def _parts(metadata: Metadata) -> Iterator[str]:
    return (text for text in metadata.text.split(";") if text.strip())
