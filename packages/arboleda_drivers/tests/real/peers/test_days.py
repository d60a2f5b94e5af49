"""The script of a day at each peer, by a good line that is cut and by a bad one.

It is a short day here, and two hundred orders by night.
"""

from __future__ import annotations

import os
from pathlib import Path

import pytest
from tests.lengths import length

from arboleda.runtime.build import Options, build

from .benches import BENCHES
from .day import GOES, GOES_BADLY, Day, noted

pytestmark = pytest.mark.system

ORDERS = int(os.environ.get("ARBOLEDA_ORDERS", length(12, whole=200)))
SEED = int(os.environ.get("ARBOLEDA_SEED", "73"))


@pytest.mark.parametrize("name", BENCHES)
@pytest.mark.parametrize("is_bad", [False, True], ids=["cuts", "bad_line"])
def test_a_day(name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, *, is_bad: bool) -> None:
    bench = BENCHES[name]
    with (
        bench.played(tmp_path / "plant", is_bad=is_bad) as (stage, (peer, cable, model)),
        noted(bench.driver_class(), monkeypatch) as sent,
    ):
        app = build(model, ("orchestrator",), Options(state_dir=tmp_path / "state"))
        goes = GOES_BADLY if is_bad else GOES | bench.goes
        day = Day(app, peer, cable, sent, SEED, goes=goes, relay=stage.relay, forms=bench.forms)
        app.start()
        try:
            day.run(ORDERS)
        finally:
            app.stop()
        print(name, "by a bad line" if is_bad else "with cuts", dict(sorted(day.counts.items())))
        assert not day.found, "\n".join(day.found)
