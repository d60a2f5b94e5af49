"""The script of a day at each peer; a short one here, two hundred orders by night."""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from tests.lengths import length

from arboleda.runtime.build import Options, build

from .benches import BENCHES
from .day import GOES, Day, noted

pytestmark = pytest.mark.system

ORDERS = int(os.environ.get("ARBOLEDA_ORDERS", length(12, whole=200)))
SEED = int(os.environ.get("ARBOLEDA_SEED", "73"))


@pytest.mark.parametrize("name", BENCHES)
def test_a_day_with_stops_and_cuts(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bench = BENCHES[name]
    with (
        bench.played(tmp_path / "plant") as (peer, cable, model),
        noted(bench.driver_class(), monkeypatch) as sent,
    ):
        app = build(model, ("orchestrator",), Options(state_dir=tmp_path / "state"))
        day = Day(app, peer, cable, sent, SEED, goes=GOES | bench.goes)
        app.start()
        try:
            day.run(ORDERS)
        finally:
            app.stop()
        print(name, dict(sorted(day.counts.items())))
        assert not day.found, "\n".join(day.found)
