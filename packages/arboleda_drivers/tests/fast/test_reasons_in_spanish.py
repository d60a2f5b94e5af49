"""Sentences of drivers while a plant runs, in Spanish; the words of a user stay."""

from __future__ import annotations

import pytest

from arboleda.dashboard.wording import words
from arboleda.drivers.supervisor import FAILED, NOT_SENT
from arboleda.model.sentence import OWN, Sentence


@pytest.mark.parametrize(
    ("said", "spanish"),
    [
        (
            FAILED(driver="pylabrobot", error="its setup has not come back for 30 s"),
            "su driver pylabrobot falló (su setup no ha vuelto en 30 s) y se inicia de nuevo",
        ),
        (
            NOT_SENT(driver="vda5050", error=OWN(text="the vehicle is still at its order a-1")),
            "su driver vda5050 no pudo enviar una orden (el vehículo sigue con su orden a-1)",
        ),
        (
            OWN(text="10.0.0.7: its feedback has stood still for 1 s"),
            "10.0.0.7: sus datos no cambian desde hace 1 s",
        ),
        (OWN(text="10.0.0.7:502 is not there"), "10.0.0.7:502 no está"),
        (OWN(text="the plate is not there"), "the plate is not there"),
    ],
)
def test_what_a_driver_says_is_said_in_spanish_and_a_users_words_stay(said: Sentence, spanish: str) -> None:
    assert words("es").say(said) == spanish
    assert words("en").say(said) == str(said)
