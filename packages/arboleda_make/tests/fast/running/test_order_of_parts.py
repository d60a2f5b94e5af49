"""Desks of drafts and versions start right after the page, and what a SIGHUP asks for after all of them."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.runtime.test_order_of_parts import Ros, names

MADE = ["DraftDesk", "MakeBench", "ProposalDesk"]


def test_desks_come_right_after_the_page(tmp_path: Path) -> None:
    found = names(tmp_path)
    page = found.index("WebPart")
    assert found[page + 1 :] == [*MADE, "HangUpPart"]


def test_a_node_of_ros_without_the_page_puts_files_to_work_and_has_no_desks(tmp_path: Path) -> None:
    found = names(tmp_path, frozenset({"orchestrator"}), link=Ros())
    assert found[-2:] == ["Orchestrator", "HangUpPart"]


def test_a_plant_that_keeps_no_record_has_no_drafts(tmp_path: Path) -> None:
    assert not {*MADE, "HangUpPart"} & {*names(tmp_path, recorded=False)}


def test_systemd_is_told_after_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "socket"))
    assert names(tmp_path)[-2:] == ["HangUpPart", "SystemdPart"]
