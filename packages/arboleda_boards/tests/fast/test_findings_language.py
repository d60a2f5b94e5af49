"""Findings about a board in Spanish."""

from __future__ import annotations

import pytest

from arboleda.dashboard.findings import findings


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            'it should refuse {"paro": 0, "seq": 3} with viejo; it says nothing about it',
            'debería rechazar {"paro": 0, "seq": 3} con viejo; su respuesta: ninguna',
        ),
        (
            "afterwards it was not seen standing still within 30 s",
            "después, no se la vio quieta en 30 s",
        ),
    ],
)
def test_a_finding_is_said_in_spanish(english: str, spanish: str) -> None:
    assert findings("es")(english) == spanish
    assert findings("en")(english) == english
