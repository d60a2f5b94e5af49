"""The lead is kept before a device is reached; times are taken of a plant before it starts."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from tests.unit.runtime.test_order_of_parts import SHIPPED, names

from arboleda.runtime import holdings
from arboleda.runtime.alarm_options import AlarmOptions
from arboleda.store.plant_memory import PlantMemory


def test_who_shares_a_memory_keeps_the_lead_before_a_device_is_reached(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    memory_of = holdings.memory_of

    def leased(*about: Any) -> PlantMemory:
        memory = memory_of(*about)
        memory.lead.renew_s = 1.0
        return memory

    monkeypatch.setattr(holdings, "memory_of", leased)
    found = names(tmp_path)
    assert found[:3] == ["OwnBroker", "LeasePart", "BridgePart"]
    assert found.index("CellResumption") > found.index("WebPart")


def test_times_of_cells_are_taken_before_alarms_and_the_plant(tmp_path: Path) -> None:
    found = names(tmp_path, of_parts=(AlarmOptions(topic="arboleda/alarms"),))
    assert found[found.index("Orchestrator") - 2 :][:2] == ["CellTimes", "AlarmsPart"]


def test_a_server_of_opc_ua_comes_after_the_page(tmp_path: Path) -> None:
    model = replace(SHIPPED, opcua_view=SimpleNamespace(port=0, isa95=()))
    found = names(tmp_path, model=model)
    assert found.index("OpcUaViewPart") > found.index("WebPart")
