"""What a plant can be put together from."""

from __future__ import annotations

import gc
import sys
from collections.abc import Iterator
from pathlib import Path
from unittest import mock

import pytest

from arboleda.model.errors import StartError
from arboleda.runtime.build import PARTS, TURN_S, Options, build
from arboleda.testing import shipped


def test_all_parts_need_no_compiled_firmware(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ARBOLEDA_BOARD", str(tmp_path / "never built"))
    app = build(shipped(), PARTS, Options(state_dir=tmp_path / "state", page=False))
    app.stop()


def test_the_firmwares_boards_are_refused_where_they_were_not_built(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv("ARBOLEDA_BOARD", str(tmp_path / "never built"))
    with pytest.raises(StartError, match="type: make firmware"):
        build(shipped(), PARTS, Options(state_dir=tmp_path / "state", page=False, firmware=True))


def test_a_part_that_does_not_exist_is_refused_with_those_that_do(tmp_path: Path) -> None:
    with pytest.raises(StartError, match="there is no part robots; there are broker, devices"):
        build(shipped(), {"bridge", "robots"}, Options(state_dir=tmp_path / "state", page=False))
    assert not (tmp_path / "state").exists()


def test_the_firmwares_boards_are_refused_at_a_broker_with_tls(tmp_path: Path) -> None:
    options = Options(state_dir=tmp_path / "state", page=False, firmware=True, broker="mqtts://broker.lab")
    with pytest.raises(StartError, match="speak no TLS"):
        build(shipped(), {"devices", "bridge", "orchestrator"}, options)


@pytest.fixture
def thawed() -> Iterator[None]:
    """Nothing is left out of garbage collection, as where a plant is a process of its own; nothing looks at
    all that other tests have made."""
    gc.unfreeze()
    with mock.patch.object(gc, "collect"):
        yield
    gc.freeze()


def test_what_was_there_before_a_plant_starts_is_left_out_of_garbage_collection(
    thawed: None, tmp_path: Path
) -> None:
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.start()
    assert gc.get_freeze_count() > 0
    app.stop()
    assert gc.get_freeze_count() == 0


def test_a_plant_in_a_process_that_has_seen_to_that_leaves_it_so(tmp_path: Path) -> None:
    gc.freeze()
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.start()
    app.stop()
    assert gc.get_freeze_count() > 0


def test_no_thread_keeps_pythons_lock_for_long_while_a_plant_runs(tmp_path: Path) -> None:
    before = sys.getswitchinterval()
    app = build(shipped(), {"orchestrator"}, Options(state_dir=tmp_path / "state", page=False))
    app.start()
    assert sys.getswitchinterval() == pytest.approx(TURN_S)
    app.stop()
    assert sys.getswitchinterval() == pytest.approx(before)
