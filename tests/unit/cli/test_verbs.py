"""The operator's verbs as commands, with a client that only takes notes."""

from __future__ import annotations

import sys
from pathlib import Path

import pytest
from typer.testing import CliRunner

from arboleda.cli import verbs
from arboleda.cli.commands import BY_OPTION
from arboleda.cli.main import cli, main
from arboleda.model.errors import ArboledaError, TextError
from arboleda.model.messages import Verb
from arboleda.model.verbs import Arguments
from arboleda.views.verb_words import ABOUT

OF_ONE_CELL = [Verb.CANCEL, Verb.RETRY, Verb.ABANDON, Verb.LOAD, Verb.TEACH]
OPTIONS = [*BY_OPTION.values()]
NEED_A_SCOPE = [*OF_ONE_CELL, Verb.RELEASE, Verb.HOME, Verb.DO, Verb.OVERRIDE, Verb.ANSWER]
PLANT_WIDE = [verb for verb in Verb if verb not in (*NEED_A_SCOPE, *OPTIONS)]


class Notes(list):
    """Stands for the plant: (verb, scope, by_hand, *arguments) of every act."""

    def __init__(self) -> None:
        super().__init__()
        self.told: dict[str, object] = {}
        self.end: dict[str, object] = {}

    def operate(self, verb: Verb, scope: str, *, by_hand: bool, arguments: Arguments) -> dict[str, object]:
        self.append((verb, scope, by_hand, *arguments))
        return {"verb": verb.value, "scope": scope, **self.told}

    def outcome(self, act: int) -> dict[str, object]:
        return {"number": act, **self.end}


@pytest.fixture
def acts(monkeypatch: pytest.MonkeyPatch) -> Notes:
    acts = Notes()
    monkeypatch.setattr(verbs, "client", lambda *_: acts)
    return acts


def arboleda(*words: str, answer: str = "") -> tuple[int, str]:
    """Exit status and output."""
    result = CliRunner().invoke(cli, words, input=answer)
    return result.exit_code, result.output


def test_every_verb_has_words() -> None:
    assert list(ABOUT) == list(Verb)


@pytest.mark.parametrize("verb", [verb for verb in Verb if verb not in OPTIONS])
def test_every_verb_is_a_command_that_says_what_it_does(verb: Verb) -> None:
    status, said = arboleda(verb.value, "--help")
    assert status == 0
    words = " ".join(said.split())
    assert " ".join(verbs.about(verb).split()) in words and verbs.STATUS in words
    assert ABOUT[verb].brief in " ".join(arboleda("help", "operate")[1].split())
    assert ("[default: the whole plant]" in words) is (verb not in NEED_A_SCOPE)


@pytest.mark.parametrize("verb", PLANT_WIDE)
def test_without_a_scope_it_is_the_whole_plant(acts: Notes, verb: Verb) -> None:
    status, said = arboleda(verb.value)
    assert (status, acts) == (0, [(verb, "", False)])
    assert said.endswith(", the whole plant\n")


def test_a_stop_that_is_not_kept_is_said_to_have_been_sent(acts: Notes, monkeypatch) -> None:
    left = {"verb": "stop", "scope": "", "outcome": "sent", "why": "it is not kept"}
    monkeypatch.setattr(acts, "operate", lambda *_, **__: left, raising=False)
    assert arboleda("stop") == (0, "sent: stop (software), the whole plant: it is not kept\n")


@pytest.mark.parametrize("verb", NEED_A_SCOPE, ids=str)
def test_what_acts_on_one_thing_does_not_guess_which(acts: Notes, verb: Verb) -> None:
    assert arboleda(verb.value)[0] == 2
    assert acts == []


ASKS_MORE = (Verb.DO, Verb.OVERRIDE, Verb.ANSWER, Verb.LOAD, Verb.TEACH, *OPTIONS)


@pytest.mark.parametrize("verb", [verb for verb in Verb if verb not in ASKS_MORE])
def test_a_scope_is_passed_on(acts: Notes, verb: Verb) -> None:
    assert arboleda(verb.value, "sis_a")[0] == 0
    assert acts == [(verb, "sis_a", False)]


def test_a_person_and_an_answer_are_passed_on(acts: Notes) -> None:
    assert arboleda("answer", "ana", "not", "yet")[0] == 0
    assert acts == [(Verb.ANSWER, "ana", False, ("answer", "not yet"))]
    assert arboleda("answer", "ana")[0] == 2
    assert arboleda("answer", "--question", "1000-12", "ana", "yes")[0] == 0
    assert acts[-1] == (Verb.ANSWER, "ana", False, ("question", "1000-12"), ("answer", "yes"))


@pytest.mark.parametrize("words", [("sis_a", "7"), ("sis_a 7",)])
def test_a_station_is_passed_on(acts: Notes, words: tuple[str, ...]) -> None:
    assert arboleda("load", "--out", *words) == (0, "done: unload, sis_a 7\n")
    assert acts == [(Verb.UNLOAD, "sis_a", False, ("station", 7))]


def test_a_place_and_a_number_of_parts_are_passed_on(acts: Notes) -> None:
    assert arboleda("load", "--out", "lab", "nest") == (0, "done: unload, lab nest\n")
    assert arboleda("load", "lab", "bin", "3") == (0, "done: load, lab bin 3\n")
    emptied = (Verb.UNLOAD, "lab", False, ("place", "nest"))
    assert acts == [emptied, (Verb.LOAD, "lab", False, ("place", "bin"), ("parts", 3))]
    assert arboleda("load", "lab")[0] == 2
    assert len(acts) == 2


def test_the_end_of_teaching_and_an_empty_plant_need_no_more_than_they_are_about(acts: Notes) -> None:
    assert arboleda("teach", "--end", "sis_a")[0] == 0
    assert arboleda("load", "--out")[0] == 0
    assert acts == [(Verb.AUTOMATIC, "sis_a", False), (Verb.UNLOAD, "", False)]
    assert arboleda("teach", "--end")[0] == 2


@pytest.mark.parametrize("scope", ["", " "])
def test_an_empty_name_is_not_the_whole_plant(acts: Notes, scope: str) -> None:
    status, said = arboleda("clear", scope)
    assert status == 2 and "the name is empty" in said
    assert acts == []


def test_stop_is_called_what_it_is(acts: Notes) -> None:
    acts.told = {"act": 1, "outcome": "sent"}
    assert arboleda("stop", "ra1") == (0, "sent: stop (software), ra1\n")


@pytest.mark.parametrize(
    ("error", "status", "said"),
    [
        (ArboledaError("No plant."), 1, "The stop was not confirmed, use the hard-wired button: No plant."),
        (TextError("No cell x."), 2, "No cell x."),
    ],
)
def test_a_stop_that_nobody_confirms_names_the_button(
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: ArboledaError,
    status: int,
    said: str,
) -> None:
    def operate(*_: object, **__: object) -> None:
        raise error

    monkeypatch.setattr(Notes, "operate", operate)
    monkeypatch.setattr(verbs, "client", lambda *_: Notes())
    monkeypatch.setattr(sys, "argv", ["arboleda", "stop"])
    with pytest.raises(SystemExit) as ended:
        main()
    assert (ended.value.code, capsys.readouterr().err) == (status, f"arboleda: {said}\n")


def test_a_robot_is_declared_homed_by_hand(acts: Notes) -> None:
    assert arboleda("home", "ra1", "--by-hand") == (0, "done: home by hand, ra1\n")
    assert acts == [(Verb.HOME, "ra1", True)]


def test_a_part_is_declared_taken_out_by_hand(acts: Notes) -> None:
    assert arboleda("release", "jaw", "--by-hand") == (0, "done: release by hand, jaw\n")
    assert acts == [(Verb.RELEASE, "jaw", True)]


@pytest.mark.parametrize(
    ("end", "status", "said"),
    [
        ({"outcome": "done", "why": None}, 0, "done: release, jaw\n"),
        ({"outcome": "failed", "why": "jaw: it is stuck"}, 3, "failed: release, jaw: jaw: it is stuck\n"),
        ({"outcome": "unchecked", "why": "not said"}, 0, "sent, not checked: release, jaw: not said\n"),
        ({"outcome": "under_way", "why": None}, 4, "still under way: release, jaw\n"),
    ],
)
def test_what_devices_do_is_waited_for_and_told_as_it_ended(
    acts: Notes, end: dict[str, object], status: int, said: str
) -> None:
    acts.told, acts.end = {"act": 7, "outcome": "under_way"}, end
    assert arboleda("release", "jaw") == (status, said)


@pytest.mark.parametrize("answer", ["n\n", "\n", ""])
def test_override_asks_first(acts: Notes, answer: str) -> None:
    status, said = arboleda("override", "middle", answer=answer)
    assert status == 1 and "A robot may still stand in middle" in said
    assert acts == []


@pytest.mark.parametrize(("options", "answer"), [((), "y\n"), (("--yes",), "")])
def test_override_frees_the_zone_once_a_person_said_so(
    acts: Notes, options: tuple[str, ...], answer: str
) -> None:
    assert arboleda("override", "middle", *options, answer=answer)[0] == 0
    assert acts == [(Verb.OVERRIDE, "middle", False)]


def test_the_plant_is_found_as_submit_finds_it(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(verbs, "client", lambda *where: asked.append(where) or Notes())
    arboleda("hold", "--plant", "my.yaml", "--state", "here", "--store", "postgresql://db", "--tokens", "t")
    assert asked == [(Path("my.yaml"), Path("here"), "postgresql://db", Path("t"))]
