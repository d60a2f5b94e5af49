"""What is kept of a task, as it is read again."""

from __future__ import annotations

import json

import pytest

from arboleda.model.messages import Fact
from arboleda.resume.trail import Trail
from arboleda.testing import Rig, shipped


@pytest.fixture
def kept() -> str:
    """What is kept of a task whose mobile robot is on its way."""
    rig = Rig(shipped("sis_a"))
    rig.wait(1.0)
    task = rig.submit("sis_a 0B 7").task
    rig.wait_for("sis_a", "drive path 0B")
    return str(rig.disk.facts[Fact.STEP][task])


def test_it_is_read_as_it_was_written(kept: str) -> None:
    assert Trail.read(kept).text() == kept


def test_what_another_version_kept_is_refused(kept: str) -> None:
    (version, *made), now = json.loads(kept)
    with pytest.raises(ValueError, match="another version"):
        Trail.read(json.dumps([[version + 1, *made], now]))


def test_what_is_damaged_is_refused(kept: str) -> None:
    begun, now = json.loads(kept)
    with pytest.raises(ValueError, match="damaged"):
        Trail.read(json.dumps([begun[:-2], now]))
