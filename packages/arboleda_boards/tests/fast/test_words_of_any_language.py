"""Words of any language in the header of a board's firmware."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.unit.kinds.test_words_of_any_language import folder as folder
from typer.testing import CliRunner

from arboleda.cli.main import cli

WIRING = """\
inputs: {llena: {pin: 34}, fria: {pin: 35}}
outputs: {vacio: {pin: 25, safe: off, on_stop: safe}, brasa: {pin: 26, safe: off, on_stop: safe}}
facts:
  puerta: told
  carga: {vacía: {fria: on}, 炭: {llena: on}, else: leña}
verbs:
  cargar: {start: {brasa: {$con: {leña: on, 炭: off}}}}
  vaciar: {start: {vacio: on}}
  mirar:  {answers: {sí: {llena: on}, else: no}}
"""


def test_the_firmwares_header_has_them_as_they_are(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (folder / "horno.wiring.yaml").write_text(WIRING, encoding="utf-8")
    words = ["firmware-config", "horno", "horno.wiring.yaml", "--plant", "plant.yaml", "-o", "made.h"]
    monkeypatch.chdir(folder)
    run = CliRunner().invoke(cli, words)
    assert run.exit_code == 0, run.output
    written = (folder / "made.h").read_text(encoding="utf-8")
    assert all(f'{{"{word}", 0.0}}' in written for word in ("vacía", "leña", "炭", "sí"))
