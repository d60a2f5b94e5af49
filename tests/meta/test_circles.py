"""No two modules of one room of the engine import each other, not even through others, or for types alone."""

from __future__ import annotations

from collections.abc import Mapping
from graphlib import CycleError, TopologicalSorter

import grimp
import pytest

ENGINE = ("model", "dispatch", "trees", "resume", "core", "kinds")


@pytest.fixture(scope="module")
def graph() -> grimp.ImportGraph:
    return grimp.build_graph("arboleda", cache_dir=None)


def circle(imports: Mapping[str, set[str]]) -> list[str]:
    """The modules of a circle of imports; none where there is no circle."""
    try:
        TopologicalSorter(imports).prepare()
    except CycleError as error:
        return list(error.args[1])
    return []


@pytest.mark.parametrize("room", ENGINE)
def test_no_modules_of_a_room_import_each_other_in_a_circle(graph: grimp.ImportGraph, room: str) -> None:
    modules = graph.find_descendants(f"arboleda.{room}")
    imports = {each: graph.find_modules_directly_imported_by(each) & modules for each in modules}
    assert any(imports.values())
    assert circle(imports) == []


def test_a_circle_is_named() -> None:
    assert circle({"a": {"b"}, "b": {"c"}, "c": {"b"}}) in (["b", "c", "b"], ["c", "b", "c"])
    assert circle({"a": {"b", "c"}, "b": {"c"}}) == []
