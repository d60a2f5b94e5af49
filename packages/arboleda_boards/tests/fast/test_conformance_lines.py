"""Lines of `arboleda conformance`, in English and in Spanish."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from arboleda.cli.language import say
from arboleda.model.plant_model import Evidence
from arboleda.testing import shipped
from arboleda_boards.conformance.command import _deeds, _line, _verdict
from arboleda_boards.conformance.judge import CHECKS, Finding

ARM = shipped("sis_b").robots["ra2"]
MOVES = next(each for each in CHECKS if each.name == "moves")
LINES = {
    "en": [
        "WRONG      moves             it does not begin to move",
        "not tried  moves             its kind has no query",
        "good       moves             A goal makes it report moving, and then standing still.",
    ],
    "es": [
        "MAL         moves             no empieza a moverse",
        "sin probar  moves             su clase no tiene ninguna consulta",
        "bien        moves             Con un objetivo informa de que se mueve, y luego de que está quieta.",
    ],
}
VERDICTS = {
    "en": f"{ARM.mqtt} reaches the level joints (joints: where it is, too), speaks as one of ids; "
    f"3 of {len(CHECKS)} checks made; wrong: moves",
    "es": f"{ARM.mqtt} alcanza el nivel joints (joints: también dónde está), y habla como una de ids; "
    f"3 de {len(CHECKS)} comprobaciones hechas; mal: moves",
}


@pytest.fixture(params=["en", "es"])
def language(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("ARBOLEDA_LANG", request.param)
    return str(request.param)


def test_the_result_of_a_check_is_said(language: str) -> None:
    found = [
        Finding(check=MOVES, wrong="it does not begin to move"),
        Finding(check=MOVES, untried="its kind has no query"),
        Finding(check=MOVES),
    ]
    assert [_line(each).plain for each in found] == LINES[language]


def test_the_level_that_a_board_reaches_is_said(language: str) -> None:
    found = [
        Finding(check=MOVES, wrong="it does not begin to move"),
        Finding(check=MOVES),
        Finding(check=MOVES),
    ]
    levels = {"reached": Evidence.JOINTS, "spoken": Evidence.IDS}
    judge = SimpleNamespace(findings=found, checks=CHECKS, is_gone=False, **levels)
    assert _verdict(ARM, judge).plain == VERDICTS[language]  # type: ignore[arg-type]


def test_a_board_that_is_gone_is_named_and_not_judged(language: str) -> None:
    judge = SimpleNamespace(findings=[Finding(check=MOVES, untried="silent")], is_gone=True)
    said = {"en": f"{ARM.mqtt} is gone since moves, and", "es": f"{ARM.mqtt} no responde desde moves, y"}
    assert _verdict(ARM, judge).plain.startswith(said[language])  # type: ignore[arg-type]


def test_what_an_arm_will_do_is_said(language: str) -> None:
    assert (
        say(_deeds(ARM)) == {"en": "move from limit to limit", "es": "moverse de un límite al otro"}[language]
    )
