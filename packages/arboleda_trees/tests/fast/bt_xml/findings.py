"""Findings of the check of a text, for the tests of this folder."""

from __future__ import annotations

from arboleda.model.errors import ConfigError
from arboleda_trees.bt_xml import checking, reading
from arboleda_trees.bt_xml.findings import Findings
from arboleda_trees.bt_xml.forest import Forest
from arboleda_trees.bt_xml.reading import MissingInclude

HEAD = '<root BTCPP_format="4">'


def looked_at(text: str | bytes, **beside: str) -> tuple[Forest, Findings, list[str]]:
    """The forest of a file t.xml, what was found, and its unknown leaves; `beside`: other files, by name."""

    def fetch(file: str, path: str, package: str) -> tuple[str, bytes]:
        if package:
            raise MissingInclude((f"there is no package {package}",))
        if path.removesuffix(".xml") not in beside:
            raise ConfigError((f"{path}: there is no such file",))
        return path, beside[path.removesuffix(".xml")].encode()

    findings = Findings()
    content = text if isinstance(text, bytes) else text.encode()
    forest = reading.read("t.xml", content, findings, fetch)
    checked = checking.check(forest, findings)
    return forest, findings, sorted(checked.unknown)


def tree(body: str, more: str = "") -> str:
    """A file with one tree, Main; its body begins on line 3."""
    return f'{HEAD}\n<BehaviorTree ID="Main">\n{body}\n</BehaviorTree>\n{more}</root>'


def mistakes(text: str | bytes, **beside: str) -> tuple[str, ...]:
    return looked_at(text, **beside)[1].mistakes


def warnings(text: str | bytes, **beside: str) -> tuple[str, ...]:
    return looked_at(text, **beside)[1].warnings
