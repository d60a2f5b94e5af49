from __future__ import annotations

import re
from string import Formatter
from typing import Any

import pytest

from arboleda.dashboard.wording import LANGUAGES, REASONS, SENTENCES, flat, tree_of, words
from arboleda.dispatch import belief, dispatcher, evidence, zones
from arboleda.dispatch.ledger import State
from arboleda.model import text
from arboleda.model.cell_states import CellState
from arboleda.model.messages import Reason, TaskState, Verb
from arboleda.model.sentence import OWN, Phrase, Sentence
from arboleda.plant_file.poses import HOME, STATION
from arboleda.recipes import storage
from arboleda.trees import paths, steps
from arboleda.trees.tree_run import IN_RECOVERY
from arboleda.views.tree_view import KINDS
from arboleda.web.languages import contents

ENGLISH = LANGUAGES[0]


def keys(language: str) -> dict[str, str]:
    return flat({name: part for name, part in tree_of(language).items() if name != SENTENCES})


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_has_the_same_keys(language: str) -> None:
    assert keys(language).keys() == keys(ENGLISH).keys()


@pytest.mark.parametrize("language", LANGUAGES)
def test_every_language_puts_the_same_values_in(language: str) -> None:
    def fields(text: str) -> set[str | None]:
        return {field for _, field, _, _ in Formatter().parse(text) if field is not None}

    english = keys(ENGLISH)
    assert [key for key, text in keys(language).items() if fields(text) != fields(english[key])] == []


@pytest.mark.parametrize("language", LANGUAGES)
@pytest.mark.parametrize(
    ("group", "known"),
    [
        ("cell_state", {state.value for state in CellState}),
        ("task_state", {state.value for state in TaskState}),
        ("command_state", {state.value for state in State}),
        ("reason", {reason.value for reason in Reason}),
        ("verb", {verb.value for verb in Verb}),
        ("does", {verb.value for verb in Verb}),
        ("kind", {*KINDS.values(), "step"}),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_every_word_of_the_plant_has_a_name(language: str, group: str, known: set[str]) -> None:
    assert known <= {key.partition(".")[2] for key in keys(language) if key.startswith(f"{group}.")}


@pytest.mark.parametrize(
    ("plant", "english", "spanish"),
    [
        (steps.MOVE(pose=STATION(number=7)), "move to station 7", "ir a la estación 7"),
        (IN_RECOVERY(step=steps.MOVE(pose=HOME())), "recovery: move to home", "recuperación: ir a reposo"),
        (belief.OFFLINE.phrase(robot="ra1"), "ra1 is offline", "ra1 está sin conexión"),
        (
            dispatcher.NO_TELEMETRY(robot="rm_sis_a", seconds=1.5, doing=paths.DRIVING(path="0B")),
            "rm_sis_a: no telemetry for 1.5 s while driving path 0B",
            "rm_sis_a: sin telemetría durante 1.5 s mientras estaba recorriendo el camino 0B",
        ),
        (
            evidence.SHORT_OF_TARGET(robot="ra1", doing=steps.MOVING(pose=STATION(number=3))),
            "ra1: stopped before its target while moving to station 3",
            "ra1: se detuvo antes de su destino mientras estaba yendo a la estación 3",
        ),
        (
            zones.NOT_QUARANTINED(zone="centre", now=zones.HELD_BY(robot="ra1")),
            "zone centre is held by ra1, which still reports; only a quarantined zone can be overridden",
            "la zona centre está ocupada por ra1, que aún informa; solo se libera una zona en cuarentena",
        ),
        (
            text.UNKNOWN_BUT_NEAR(
                word="'0D'", kind=storage.PATH(), where="sis_a", there=("0A", "0B"), near="0A"
            ),
            "'0D' is not a path of sis_a; there are 0A, 0B; did you mean 0A?",
            "'0D' no es un camino de sis_a; hay 0A, 0B; ¿quiso decir 0A?",
        ),
    ],
    ids=str,
)
def test_the_plants_sentences_are_said_in_spanish(plant: Sentence, english: str, spanish: str) -> None:
    assert words("es").say(plant) == spanish
    assert words("en").say(plant) == str(plant) == english


def test_what_is_no_sentence_stays_as_it_is() -> None:
    assert words("es").say("polish the part") == "polish the part"


@pytest.mark.parametrize(
    ("said", "spanish"),
    [
        (OWN(text="the plate is not there"), "the plate is not there"),
        (
            OWN(text="10.0.0.7: port 29999: [Errno 111] Connection refused"),
            "10.0.0.7: puerto 29999: [Errno 111] conexión rechazada",
        ),
    ],
)
def test_what_a_driver_says_is_said_in_spanish_and_a_users_words_stay(said: Sentence, spanish: str) -> None:
    assert words("es").say(said) == spanish
    assert words("en").say(said) == str(said)


@pytest.mark.parametrize("language", LANGUAGES)
def test_reasons_of_drivers_have_the_values_of_their_english(language: str) -> None:
    def fields(text: str) -> list[str]:
        return sorted(field for _, field, _, _ in Formatter().parse(text) if field is not None)

    rows = contents(language, REASONS).items()
    assert [english for english, other in rows if fields(english) != fields(other)] == []


@pytest.mark.parametrize(
    ("language", "said"),
    [
        ("en", "press: gave up (jammed) while homing"),
        ("es", "press: se dio por vencido (atasco) mientras estaba"),
    ],
)
def test_a_word_of_a_board_is_said_in_the_language_of_the_page(language: str, said: str) -> None:
    doing = Phrase("doing.home", "homing")()
    sentence = evidence.GAVE_UP(robot="press", word="atasco", doing=doing)
    assert words(language).say(sentence).startswith(said)
    assert str(sentence) == "press: gave up (atasco) while homing", "as records and programs have it"


def test_an_unknown_language_is_english() -> None:
    assert words("xx").language == "en"


def spanish() -> dict[str, str]:
    """Every Spanish text by its key, or by the sentence of the plant that it stands for."""
    return keys("es") | tree_of("es")[SENTENCES]


def test_spanish_frees_zones_and_nothing_else() -> None:
    """ "Liberar" is the override of a zone; a latch is "desenclavar", a part "soltar"."""
    frees = {key for key, text in spanish().items() if "liber" in text.lower()}
    about_zones = {"zone.not_quarantined", "refusal.still_works", "refusal.still_uses"}
    assert frees == about_zones | {key for key in spanish() if "overrid" in key and key != "asks.override"}


def test_nothing_about_the_stop_can_be_read_as_for_or_as_stops() -> None:
    """In Spanish "para" is both: "Para todos los robots"."""
    ambiguous = re.compile(r"\bpara\b", re.IGNORECASE)
    about = {key: text for key, text in spanish().items() if re.search(r"\bstop|abort", key)}
    assert len(about) > 20
    assert [text for text in about.values() if ambiguous.search(text)] == []
    assert [text for text in spanish().values() if ambiguous.match(text)] == []


def test_a_missing_key_is_an_error() -> None:
    with pytest.raises(KeyError):
        words("en")("tasks.nothing")


def test_the_stop_is_never_called_by_the_name_of_the_safety_function() -> None:
    said: list[Any] = [text for language in LANGUAGES for text in keys(language).values()]
    assert not [text for text in said if re.search(r"(?i)emergenc", text)]
