from __future__ import annotations

import json
from typing import Any

import pytest

from arboleda.model.sentence import in_json
from arboleda.runtime.parts.slices import Slices
from arboleda.testing import Rig, shipped
from arboleda_ros import view_text


def text_of(snapshot: dict[str, Any]) -> str:
    slices = Slices(view_text.in_parts(snapshot))
    while not slices.cut(0.0):
        pass
    return slices.result


@pytest.mark.parametrize("plain", [{}, {"a": []}, {"a": [1, {"ñ": [None]}], "b": {"c": "\n"}, "d": 1.5}])
def test_the_parts_make_the_text_of_the_whole(plain: dict[str, Any]) -> None:
    assert text_of(plain) == json.dumps(plain, ensure_ascii=False)


def test_a_snapshot_has_a_part_for_every_row() -> None:
    rig = Rig(shipped())
    rig.submit("sis_a 0B 7")
    rig.wait(9.0)
    snapshot = rig.snapshot()
    assert text_of(snapshot) == json.dumps(snapshot, ensure_ascii=False, default=in_json)
    rows = sum(len(value) for value in snapshot.values() if isinstance(value, list))
    assert len(list(view_text.in_parts(snapshot))) == rows >= 10


def test_a_part_that_fails_ends_the_work() -> None:
    slices = Slices(view_text.in_parts({"a": [object()]}))
    with pytest.raises(TypeError):
        slices.cut(0.0)
    assert slices.over
