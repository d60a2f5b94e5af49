"""Picture of a tree that was proposed, as SVG: what runs, drawn by what draws trees elsewhere."""

from __future__ import annotations

from arboleda.extension import ConfigError


def picture_of(file: str, content: bytes) -> str:
    """The main tree of a file, or its first one; "" where nothing of it can be drawn."""
    from arboleda.drawing.picture import picture
    from arboleda.drawing.svg import svg
    from arboleda_trees.bt_xml import reading, rows  # which a plant without proposals does not need
    from arboleda_trees.bt_xml.findings import Findings

    try:
        forest = reading.read(file, content, Findings())
    except ConfigError:
        return ""
    name = forest.main or next(iter(forest.trees), None)
    return "" if name is None or name not in forest.trees else svg(picture(rows.rows(forest, name)))
