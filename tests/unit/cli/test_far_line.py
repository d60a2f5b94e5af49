"""Why a plant that another host leads does not do what it is asked, in English and in Spanish."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.cli.language import say_error
from arboleda.cli.line import Answer, FarLine
from arboleda.cli.remote_plant import RemotePlant
from arboleda.client.errors import NoAnswer
from arboleda.model.errors import ArboledaError
from arboleda.runtime.leader import LeaderInfo

URL = "http://10.0.0.7:8080"
LED = LeaderInfo(plant="demo", host="host-a", process=1, url=URL, epoch=2)
LEADERS = {"en": "Plant demo is led on host-a", "es": "La planta demo la dirige host-a"}


@pytest.fixture(params=["en", "es"])
def language(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.setenv("ARBOLEDA_LANG", request.param)
    return str(request.param)


@pytest.fixture
def line(tmp_path: Path) -> FarLine:
    return RemotePlant(tmp_path, lambda: ("", ""), dict).line(LED)


def refused(line: FarLine, status: int, **body: object) -> str:
    with pytest.raises(ArboledaError) as error:
        line.taken(Answer(status=status, body=body, headers={}))
    return say_error(error.value)


def test_an_address_that_one_host_alone_reaches_is_said(tmp_path: Path, language: str) -> None:
    near = LeaderInfo(plant="demo", host="host-a", process=1, url="http://127.0.0.1:80", epoch=2)
    with pytest.raises(ArboledaError) as error:
        RemotePlant(tmp_path, lambda: ("", ""), dict).line(near)
    rest = {"en": "which is reached from host-a alone", "es": "adonde solo se llega desde host-a"}
    assert say_error(error.value).startswith(
        f"{LEADERS[language]}, {'at' if language == 'en' else 'en'} http://127.0.0.1:80, {rest[language]}"
    )


def test_that_the_leader_changes_is_said(line: FarLine, language: str) -> None:
    rest = {"en": "changes just now", "es": "justo ahora cambia quién dirige"}
    said = refused(line, 503, standby=True, sentence="waits")
    assert said.startswith(LEADERS[language]) and rest[language] in said


def test_a_refused_token_is_said_with_advice(line: FarLine, language: str) -> None:
    said = refused(line, 401, sentence="A token is needed.")
    advice = {"en": "(no token is known for it): copy ", "es": "(no se conoce ningún token de allí): copie "}
    assert said.startswith(LEADERS[language]) and advice[language] in said


@pytest.mark.parametrize(
    ("clause", "spanish"),
    [
        (f", which cannot be reached at {URL} (refused).", f", pero no se llega a ella en {URL} (refused)."),
        (f", which gave no answer at {URL} in 10 s.", f", pero no respondió en {URL} en 10 s."),
        (
            ", and what answers is no plant (it sends no JSON).",
            ", y lo que responde no es una planta (no envía JSON).",
        ),
    ],
)
def test_its_silence_is_said(line: FarLine, language: str, clause: str, spanish: str) -> None:
    silent = line._silent(NoAnswer("No answer", may_have_heard=False, clause=clause))
    assert silent == f"{LEADERS[language]}{spanish if language == 'es' else clause}"
