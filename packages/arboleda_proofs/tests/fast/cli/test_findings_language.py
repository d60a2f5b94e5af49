"""Findings of runs and rules of invariants in Spanish."""

from __future__ import annotations

import pytest
from tests.unit.cli.test_findings_language import SENTENCES

from arboleda.dashboard.findings import findings
from arboleda_proofs.campaigns.setting import rules


@pytest.mark.parametrize("rule", list(rules().values()), ids=list(rules()))
def test_the_rule_of_an_invariant_is_said_in_spanish(rule: str) -> None:
    assert findings("es")(f"  must hold  {rule}") == f"  debe cumplirse {SENTENCES[rule]}"


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            "  bench fill: jaw: It restarts and forgets: the place of arm is (1.0, 0.0), not (2.0, 0.0); "
            "4 runs, e.g. just before arm: moving to nest (3.200 s)",
            "  bench fill: jaw: Se reinicia y olvida: el lugar de arm es (1.0, 0.0), no (2.0, 0.0); "
            "4 ejecuciones, como justo antes de arm: yendo a nest (3.200 s)",
        ),
        (
            "  begins     in the middle after arm: moving to nest (3.200 s)",
            "  empieza        a mitad de camino tras arm: yendo a nest (3.200 s)",
        ),
        (
            "  begins     just before the request (2.000 s)",
            "  empieza        justo antes de la petición (2.000 s)",
        ),
        (
            "    26.358  ra1: Messages are lost (up, 0.13), for 2.706 s",
            "    26.358  ra1: Se pierden mensajes (up, 0.13), durante 2.706 s",
        ),
        (
            "lab weigh: failed: rejected without any fault: no",
            "lab weigh: falló: rechazada sin ningún fallo: no",
        ),
        ("FAULT: gives_up jaw rejected for 3.000 s", "FALLO: gives_up jaw rejected durante 3.000 s"),
        ("    a question may: wheel.gauge()", "    una pregunta puede notarlo: wheel.gauge()"),
        (
            "2 seeds (1 to 2), 38 cycles, 0 faults, 203 s of plant time in 2 s (a, b)",
            "2 semillas (1 a 2), 38 ciclos, 0 fallos, 203 s de tiempo de la planta en 2 s (a, b)",
        ),
        (
            "  was seen   MoveJoints 1-7 of ra1 was sent while SetEffector 1-6 of ra1 was open",
            "  se vio         se envió MoveJoints 1-7 de ra1 mientras SetEffector 1-6 de ra1 estaba abierta",
        ),
        (
            "  was seen   ra1 is not online by what the plant believes",
            "  se vio         según cree la planta, ra1 no está en línea",
        ),
        (
            "  was seen   ra1 begins to move unasked",
            "  se vio         ra1 empieza a moverse sin que nadie lo pida",
        ),
        ("  faults     1 of 7 faults is enough:", "  fallos         basta 1 de 7 fallos:"),
        ("  faults     3 of 7 faults are enough:", "  fallos         bastan 3 de 7 fallos:"),
    ],
)
def test_a_finding_is_said_in_spanish(english: str, spanish: str) -> None:
    assert findings("es")(english) == spanish
    assert findings("en")(english) == english
