"""Words of declared kinds with letters of any language: in check, on the wire, and where people read."""

from __future__ import annotations

import json
from pathlib import Path
from unicodedata import normalize

import pytest

from arboleda.dashboard.page_state import PageState
from arboleda.kinds.declared import Device
from arboleda.model.errors import ConfigError, PayloadError
from arboleda.model.messages import MotionState, Report
from arboleda.model.plant_model import PlantModel
from arboleda.plant_file import loader
from arboleda.views import view
from arboleda.wire.payloads import DEVICE, decode
from arboleda.wire.status import from_status, to_status
from arboleda.wire.topics import Channel
from arboleda_ros import order

from ...plants import plant_text
from ..dashboard.conftest import LINKS
from .lab import Bench

PLANT = plant_text(__file__, "words_of_any_language")
RECIPES = """\
from arboleda.recipes import Choice, Kit, recipe, work

@recipe("cocer")
def cocer(cell: Kit, con: Choice["leña", "炭"]):
    horno = cell.device("horno")
    hay = horno.mirar()
    cocido = [horno.cargar(con=con), horno.vaciar()]
    return work(hay, cell.choose(hay, {"sí": cocido, "no": cell.fail("no hay")}))
"""


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "recetas.py").write_text(RECIPES, encoding="utf-8")
    (tmp_path / "plant.yaml").write_text(PLANT, encoding="utf-8")
    return tmp_path


def plant(folder: Path, text: str = PLANT) -> PlantModel:
    return loader.parse("plant.yaml", text.encode(), folder)


def kiln(folder: Path) -> Device:
    device = plant(folder).robots["horno"]
    assert isinstance(device, Device)
    return device


def test_a_task_with_them_is_done_by_the_virtual_board(folder: Path) -> None:
    here = Bench(plant(folder))
    here.submit("taller cocer LEÑA")
    assert here.wait(10.0, lambda: here.told[-1:] == ["horno vaciar"])
    assert here.outcome().state.value == "done"
    orders = [said.payload for _, said in here.to_boards if said.topic == "horno/orden"]
    assert b'"valores":{"con":"le\xc3\xb1a"}' in orders[1]
    task = view.task_by_id(here.plant, "t-1000-1")
    assert [each["answer"] for each in task["answers"]] == ["sí"]  # type: ignore[index]


def test_the_page_and_the_view_show_them_as_they_are(folder: Path) -> None:
    here = Bench(plant(folder))
    story = PageState(view.layout(here.plant.model), [])
    here.submit("taller cocer 炭")
    assert here.wait(10.0, lambda: here.told[-1:] == ["horno vaciar"])
    here.wait(0.3)
    snapshot = view.snapshot(here.plant)
    story.see(snapshot, 1000.0)
    name, said, _ = story.face("es", LINKS)["row/devices.taller/horno"]["texts"]
    assert (name, said) == ("horno", "puerta abierta, carga 炭")
    assert '"carga": "炭"' in json.dumps(snapshot, ensure_ascii=False, default=str)


def test_what_fails_names_them_as_they_are(folder: Path) -> None:
    here = Bench(plant(folder))
    here.submit("taller cocer carbón")
    assert here.changes[-1].state.value == "refused"
    assert str(here.changes[-1].sentence) == "con of taller cannot be 'carbón'; there are leña, 炭"
    device = kiln(folder)
    report = Report(at=0.0, robot="horno", facts=(("carga", "salmón"),))
    assert device.objection(report) == "carga is 'salmón'; horno knows vacía, leña, 炭"


@pytest.mark.parametrize("form", ["NFC", "NFD"])
def test_how_an_accent_is_written_does_not_count(folder: Path, form: str) -> None:
    text = normalize(form, PLANT)  # type: ignore[arg-type]
    assert plant(folder, text).robots["horno"].kind == kiln(folder).kind  # type: ignore[attr-defined]
    raw = json.dumps({"estado": 0, "datos": {"carga": normalize(form, "vacía")}}).encode()  # type: ignore[arg-type]
    assert decode(Channel.TELEMETRY, raw, axes=DEVICE).facts == (("carga", "vacía"),)  # type: ignore[union-attr]


def test_they_pass_over_ros_2_as_they_are(folder: Path) -> None:
    device = kiln(folder)
    command = device.kind.command(id="7-1", robot="horno", verb="cargar", values={"con": "leña"})
    text = order.write(command)
    assert "leña" in text
    assert order.read(device, text) == (command, False)
    report = Report(
        at=0.0,
        robot="horno",
        state=MotionState.STOPPED,
        answered="7-3",
        answer="sí",
        facts=(("puerta", "abierta"), ("carga", "炭")),
    )
    assert from_status(0.0, device, to_status(device, report)) == report


@pytest.mark.parametrize("text", ["\u202eoloc", "a\u200bb", "a\u00adb"], ids=ascii)
def test_what_a_board_says_can_be_printed(text: str) -> None:
    raw = json.dumps({"estado": 0, "datos": {"carga": text}}).encode()
    with pytest.raises(PayloadError, match="printable characters"):
        decode(Channel.TELEMETRY, raw, axes=DEVICE)


@pytest.mark.parametrize(
    ("old", "new", "sentence"),
    [
        (
            "mirar:  {effect: query, answers: [sí, no]}",
            "mirar:  {effect: query, answers: [no, 'dice \"sí\"']}",
            "9:45: kinds.horno.verbs.mirar.answers[1]: an answer to mirar of horno: it is 'dice \"sí\"'; ",
        ),
        (
            "entreabierta]",
            f"{'é' * 17}]",
            f"5:40: kinds.horno.facts.puerta[2]: puerta of horno: it is '{'é' * 17}'; at most 32 bytes",
        ),
        (
            "with: {con: [leña, 炭]}, sets: {carga: $con}",
            f"with: {{con: [leña, {'炭' * 11}]}}, sets: {{carga: leña}}",
            "7:52: kinds.horno.verbs.cargar.with.con[1]: con of cargar of horno: it is '炭炭",
        ),
    ],
    ids=["quote", "fact too long", "parameter too long"],
)
def test_a_word_that_no_message_takes_is_refused_at_its_place(
    folder: Path, old: str, new: str, sentence: str
) -> None:
    assert old in PLANT
    with pytest.raises(ConfigError) as refused:
        plant(folder, PLANT.replace(old, new))
    assert [each for each in refused.value.problems if each.startswith(f"plant.yaml:{sentence}")]
    assert not [each for each in refused.value.problems if "\\x" in each or "cells.taller" in each]
