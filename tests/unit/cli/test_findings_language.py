"""What is found in files and runs, in Spanish: by templates of its English."""

from __future__ import annotations

import re
from string import Formatter

import pytest

from arboleda.dashboard.findings import findings, plant_reasons
from arboleda.dashboard.wording import words
from arboleda.model.sentence import Phrase
from arboleda.web.languages import contents
from arboleda.web.languages.templates import Templates

from ...plants import rows

SENTENCES: dict[str, str] = contents("es", "findings")["sentences"]


def slots(text: str) -> list[str]:
    return sorted(name for _, name, _, _ in Formatter().parse(text) if name is not None)


def test_each_sentence_has_the_values_of_its_english() -> None:
    assert {english for english, other in SENTENCES.items() if slots(english) != slots(other)} == set()


@pytest.mark.parametrize(
    ("english", "spanish"),
    rows(__file__, "findings"),
)
def test_a_finding_is_said_in_spanish(english: str, spanish: str) -> None:
    assert findings("es")(english) == spanish
    assert findings("en")(english) == english


def test_no_finding_can_be_read_as_for_or_as_stops() -> None:
    """In Spanish "para" is both: "Para todos los robots"."""
    assert [each for each in SENTENCES.values() if re.match(r"\W*para\b", each, re.IGNORECASE)] == []


def test_a_line_of_no_template_stays_as_it_is() -> None:
    assert findings("es")("Zebras graze here.") == "Zebras graze here."


def test_what_is_quoted_stays_as_it_is() -> None:
    templates = Templates({'there is no "{0}"': 'no hay "{0}"', "door": "puerta"})
    assert templates('there is no "door"') == 'no hay "door"'


def test_the_template_with_most_letters_is_taken() -> None:
    templates = Templates({"{0} is {1}": "{0} es {1}", "{0} is too long: {1}": "{0} es demasiado largo: {1}"})
    assert templates("name is too long: 40") == "name es demasiado largo: 40"


@pytest.mark.parametrize(
    ("english", "spanish", "text", "said"),
    [
        ("{{{0}}} is open", "{{{0}}} está abierta", "{door} is open", "{door} está abierta"),
        ("ra{0}: {1}s wait", "ra{0}: esperan {1}", "ra7: parts wait", "ra7: esperan part"),
        ("({0} mm)", "[{0} mm]", "(7 a mm)", "[7 a mm]"),
    ],
)
def test_a_template_is_found_whatever_words_its_slots_go_on_with(
    english: str, spanish: str, text: str, said: str
) -> None:
    assert Templates({english: spanish, "open": "abierto"})(text) == said


def test_of_ways_that_say_as_much_that_of_the_fewest_templates_is_taken() -> None:
    templates = Templates(
        {"{0} is {1}": "{0} está {1}", "{0} is {1}; on {2}": "{0} es {1}; en {2}", "on": "en"}
    )
    assert templates("door is open; on top") == "door es open; en top"


def test_values_of_a_part_are_left_to_it() -> None:
    templates = Templates(
        {"Invalid value for {name}: {why}": "Mal {name}: {why}"}, lambda slot, value: value.upper()
    )
    assert templates("Invalid value for port: low") == "Mal PORT: LOW"


def test_a_slot_that_stands_twice_has_the_same_words_twice() -> None:
    templates = Templates({"{arm} is away; home {arm} helps": "{arm} no está; home {arm} ayuda"})
    assert templates("ur1 is away; home ur1 helps") == "ur1 no está; home ur1 ayuda"
    assert templates("ur1 is away; home ur2 helps") == "ur1 is away; home ur2 helps"


@pytest.mark.sampled(3)
@pytest.mark.parametrize("reason", plant_reasons(), ids=lambda each: each.key)
def test_a_reason_of_the_plant_is_said_inside_a_finding_as_on_the_page(reason: Phrase) -> None:
    sentence = reason(**{slot: "x9" if spec == "" else 7 for slot, spec in values(reason)})
    english = f'task failed once without any fault: recipe rinse (rejected), as in "rinse 1": {sentence}'
    assert findings("es")(english).endswith(f'"rinse 1": {words("es").say(sentence)}')


def values(phrase: Phrase) -> list[tuple[str, str]]:
    return [(name, spec or "") for _, name, spec, _ in Formatter().parse(phrase.english) if name is not None]
