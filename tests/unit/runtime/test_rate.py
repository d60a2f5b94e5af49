"""What a plant can be put together from, and virtual robots that are faster than the real ones."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.kinds.arm import Arm
from arboleda.kinds.declared import Device
from arboleda.kinds.mobile import Mobile
from arboleda.model.errors import StartError
from arboleda.runtime.build import PARTS, Options, build
from arboleda.runtime.rate import at_rate
from arboleda.testing import shipped

from ..kinds.lab import model


def test_arms_and_mobile_robots_move_so_many_times_as_fast() -> None:
    plain, fast = shipped("sis_a"), at_rate(shipped("sis_a"), 2.0)
    for before, after in zip(plain.robots.values(), fast.robots.values(), strict=True):
        if isinstance(before, Arm) and isinstance(after, Arm):
            assert [joint.speed * 2.0 for joint in before.joints] == [joint.speed for joint in after.joints]
            ramps = [joint.speed / joint.acceleration for joint in after.joints]
            assert ramps == pytest.approx([joint.speed / joint.acceleration / 2.0 for joint in before.joints])
        elif isinstance(before, Mobile) and isinstance(after, Mobile):
            assert after.speed == before.speed * 2.0


def test_what_a_device_does_takes_less_and_a_slow_one_is_waited_for_longer() -> None:
    assert baking(10.0) == (2.0, 30.0)
    assert baking(0.5) == (40.0, 60.0)


def baking(rate: float) -> tuple[float, float]:
    oven = at_rate(model(), rate).robots["oven"]
    assert isinstance(oven, Device)
    return oven.kind.verbs["bake"].takes_s, oven.kind.verbs["bake"].at_most_s


def test_a_slow_plant_has_longer_to_come_to_rest() -> None:
    plain = shipped("sis_a")
    assert at_rate(plain, 0.2).timing.stop_timeout_s == pytest.approx(5 * plain.timing.stop_timeout_s)
    assert at_rate(plain, 5.0).timing == plain.timing


def test_all_parts_need_no_compiled_firmware(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv("ARBOLEDA_BOARD", str(tmp_path / "never built"))
    app = build(shipped(), PARTS, Options(state_dir=tmp_path / "state", page=False))
    app.stop()
    assert app.orchestrator is not None


def test_a_part_that_does_not_exist_is_refused_with_those_that_do(tmp_path: Path) -> None:
    with pytest.raises(StartError, match="there is no part robots; there are broker, devices"):
        build(shipped(), {"bridge", "robots"}, Options(state_dir=tmp_path / "state", page=False))
    assert not (tmp_path / "state").exists()
