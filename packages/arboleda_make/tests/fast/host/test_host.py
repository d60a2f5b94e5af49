"""Without the signal a plant leaves signals as they are."""

from __future__ import annotations

import signal

import pytest

from arboleda_make.versions import hang_up


def test_without_the_signal_the_plant_leaves_signals_as_they_are(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(hang_up, "HANG_UP", None)
    before = signal.getsignal(signal.SIGHUP)
    part = hang_up.HangUpPart(lambda _: {})
    part.start()
    assert signal.getsignal(signal.SIGHUP) is before
    part.stop()
