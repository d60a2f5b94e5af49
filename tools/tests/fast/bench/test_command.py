"""Command with benchmarks that measure, and with one that cannot."""

from __future__ import annotations

import json
from types import SimpleNamespace

import pytest

from arboleda.model.errors import ArboledaError, ConfigError
from arboleda_bench import catalog, command
from arboleda_bench.result import Aim, Figure, Result


@pytest.fixture(autouse=True)
def benches(monkeypatch):
    """Two benchmarks: one lacks something, the other falls short."""

    def lacking(scene):
        raise ArboledaError("there is no broker")

    def slow(scene):
        return Result(figures=[Figure(name="p50", unit="ms", ours=3.0, floor=1.0, aim=Aim(most=2))])

    monkeypatch.setattr(command, "revision", lambda: "0123abcd")
    known = {"first": lacking, "second": slow}
    monkeypatch.setattr(catalog, "NAMES", tuple(known))
    monkeypatch.setattr(catalog, "about", lambda name: f"about {name}")
    monkeypatch.setattr(catalog, "module", lambda name: SimpleNamespace(run=known[name]))


def run(*names, file=None):
    return command.run(names, quick=True, file=file, listed=False)


def test_one_that_cannot_run_is_named_and_the_others_run(capsys, tmp_path):
    file = tmp_path / "bench.json"
    assert run(file=file) == 1
    said = capsys.readouterr().out
    assert "first was not measured: there is no broker" in said
    assert "about second" in said
    assert list(json.loads(file.read_text())["benches"]) == ["second"]


def test_what_falls_short_is_marked_and_does_not_fail(capsys):
    assert run("second") == 0
    assert "3x" in (said := capsys.readouterr().out) and "falls short" in said


def test_an_unknown_name_measures_nothing():
    with pytest.raises(ConfigError, match="there is no benchmark 'secnd' \\(did you mean second\\?\\)"):
        run("first", "secnd")
