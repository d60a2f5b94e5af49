"""What a plant can be put together from."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import StartError
from arboleda.runtime.build import PARTS, Options, build
from arboleda.testing import shipped


def test_all_parts_need_no_compiled_firmware(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ARBOLEDA_BOARD", str(tmp_path / "never built"))
    app = build(shipped(), PARTS, Options(state_dir=tmp_path / "state", page=False))
    app.stop()
    assert app.orchestrator is not None


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
