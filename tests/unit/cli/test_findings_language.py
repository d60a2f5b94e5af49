"""What is found in files and runs, in Spanish: by templates of its English."""

from __future__ import annotations

from string import Formatter

import pytest

from arboleda.campaigns.setting import rules
from arboleda.dashboard.findings import findings, plant_reasons
from arboleda.dashboard.wording import words
from arboleda.model.sentence import Phrase
from arboleda.web.languages import contents
from arboleda.web.languages.templates import Templates

SENTENCES: dict[str, str] = contents("es", "findings")["sentences"]
FEWER = {"  faults     {0} of {1} {2} enough:"}  # the value is a verb, of which Spanish needs no second form


def slots(text: str) -> list[str]:
    return sorted(name for _, name, _, _ in Formatter().parse(text) if name is not None)


def test_each_sentence_has_the_values_of_its_english() -> None:
    unlike = {english for english, other in SENTENCES.items() if slots(english) != slots(other)}
    assert unlike == FEWER


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            'plant.yaml:25:18: cells.studio.queue_limit: must be a whole number, is "five"',
            'plant.yaml:25:18: cells.studio.queue_limit: debe ser un número entero; es "five"',
        ),
        (
            'table.turn.needs: there is no fact "clmp"; did you mean "clamp"?; facts: angle, clamp',
            'table.turn.needs: no hay ningún hecho "clmp"; ¿quiso decir "clamp"?; hechos: angle, clamp',
        ),
        (
            "2 seeds (1 to 2), 38 cycles, 0 faults, 203 s of plant time in 2 s (a, b)",
            "2 semillas (1 a 2), 38 ciclos, 0 fallos, 203 s de tiempo de la planta en 2 s (a, b)",
        ),
    ],
)
def test_a_finding_is_said_in_spanish(english: str, spanish: str) -> None:
    assert findings("es")(english) == spanish
    assert findings("en")(english) == english


def test_a_line_of_no_template_stays_as_it_is() -> None:
    assert findings("es")("Zebras graze here.") == "Zebras graze here."


def test_what_is_quoted_stays_as_it_is() -> None:
    templates = Templates({'there is no "{0}"': 'no hay "{0}"', "door": "puerta"})
    assert templates('there is no "door"') == 'no hay "door"'


def test_the_template_with_most_letters_is_taken() -> None:
    templates = Templates({"{0} is {1}": "{0} es {1}", "{0} is too long: {1}": "{0} es demasiado largo: {1}"})
    assert templates("name is too long: 40") == "name es demasiado largo: 40"


def test_values_of_a_part_are_left_to_it() -> None:
    templates = Templates(
        {"Invalid value for {name}: {why}": "Mal {name}: {why}"}, lambda slot, value: value.upper()
    )
    assert templates("Invalid value for port: low") == "Mal PORT: LOW"


def test_a_slot_that_stands_twice_has_the_same_words_twice() -> None:
    templates = Templates({"{arm} is away; home {arm} helps": "{arm} no está; home {arm} ayuda"})
    assert templates("ur1 is away; home ur1 helps") == "ur1 no está; home ur1 ayuda"
    assert templates("ur1 is away; home ur2 helps") == "ur1 is away; home ur2 helps"


@pytest.mark.parametrize("reason", plant_reasons(), ids=lambda each: each.key)
def test_a_reason_of_the_plant_is_said_inside_a_finding_as_on_the_page(reason: Phrase) -> None:
    sentence = reason(**{slot: "x9" if spec == "" else 7 for slot, spec in values(reason)})
    english = f'task failed once without any fault: recipe rinse (rejected), as in "rinse 1": {sentence}'
    assert findings("es")(english).endswith(f'"rinse 1": {words("es").say(sentence)}')


@pytest.mark.parametrize("rule", list(rules().values()), ids=list(rules()))
def test_the_rule_of_an_invariant_is_said_in_spanish(rule: str) -> None:
    assert findings("es")(f"  must hold  {rule}") == f"  debe cumplirse {SENTENCES[rule]}"


def values(phrase: Phrase) -> list[tuple[str, str]]:
    return [(name, spec or "") for _, name, spec, _ in Formatter().parse(phrase.english) if name is not None]
