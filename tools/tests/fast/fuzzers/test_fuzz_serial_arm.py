"""A short run of tools/fuzz-serial-arm, and that it finds what it is for."""

from __future__ import annotations

from typing import Any

import pytest
from tests.scripts import load

from arboleda_drivers.serial_arm import packets

RUNS = 200


@pytest.fixture
def fuzz() -> Any:
    return load("fuzz-serial-arm")


def test_nothing_is_raised_and_nothing_refused_counts(fuzz: Any) -> None:
    seen = fuzz.run(RUNS, 1)
    assert sum(seen.values()) == RUNS
    assert seen["refused"] > RUNS / 2 and seen["answer found among others"] > 0, seen


@pytest.mark.long
def test_a_check_sum_that_is_not_looked_at_would_be_found(fuzz: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    checked = packets.Protocol2.unpacked

    def unchecked(self: packets.Protocol2, data: bytes, *, reply: bool) -> packets.Packet:
        if not reply:
            return checked(self, data, reply=False)
        return packets.Packet(id=data[4], code=data[8], data=data[9:-2])

    monkeypatch.setattr(packets.Protocol2, "unpacked", unchecked)
    assert fuzz.run(RUNS, 1)["changed answer read"] > RUNS / 10
