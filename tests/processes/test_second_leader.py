"""A process that was not the first to lead a plant goes on waiting, with all that it needs to lead later."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.runtime import holdings
from arboleda.runtime.build import Options, build
from arboleda.runtime.parts.page import PagePlant
from arboleda.store.lead import OtherLeader
from arboleda.store.plant_memory import PlantMemory
from arboleda.testing import shipped


def test_it_has_made_no_page_of_which_a_process_has_one(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    pages, memory_of = [], holdings.memory_of

    def led_by_another(*about: object) -> PlantMemory:
        memory: PlantMemory = memory_of(*about)
        monkeypatch.setattr(memory.lead, "take", refuse)
        return memory

    def refuse(epoch: int) -> int:
        raise OtherLeader("another process leads")

    monkeypatch.setattr(holdings, "memory_of", led_by_another)
    monkeypatch.setattr(PagePlant, "mount", lambda page, app: pages.append(page))
    for _ in range(2):
        with pytest.raises(OtherLeader):
            build(shipped("sis_a"), {"orchestrator", "web"}, Options(state_dir=tmp_path))
    assert pages == []
