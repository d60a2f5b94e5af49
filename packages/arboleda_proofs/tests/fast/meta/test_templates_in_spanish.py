"""Names of faults and mishaps, and sentences with them, in Spanish."""

from __future__ import annotations

import pytest

from arboleda.dashboard.findings import findings
from arboleda.dashboard.wording import words
from arboleda_proofs.simulator.faults import KINDS
from arboleda_proofs.simulator.faults.titles import FORMS, title
from arboleda_proofs.simulator.mishaps import MISHAPS


@pytest.mark.parametrize("kind", KINDS)
def test_a_fault_has_a_name_in_both_languages(kind: str) -> None:
    names = [title(kind), *(name for (of, _), name in FORMS.items() if of == kind)]
    assert [name for name in names if findings("es")(name) == name] == []


def test_a_mishap_has_the_name_of_its_fault_in_both_languages() -> None:
    named = [each for each in MISHAPS.values() if each.name != "slow"]  # which says how much
    assert [str(each.sentence) for each in named] == [title(*each.faults[0]) for each in named]
    spanish = findings("es")
    assert [words("es").say(each.sentence) for each in named] == [
        spanish(str(each.sentence)) for each in named
    ]


@pytest.mark.parametrize(
    ("english", "spanish"),
    [
        (
            "HELD: all 12 runs, every single fault of 3 kinds at every instant",
            "SE CUMPLE en 12 ejecuciones: cada fallo suelto de 3 tipos en cada instante",
        ),
        (
            "BROKEN: 2 breaches and 1 task without any fault; 3 of 40 runs",
            "NO SE CUMPLE: 2 incumplimientos y 1 tarea sin ningún fallo; 3 de 40 ejecuciones",
        ),
        (
            "2 recipes, 1 task, 70 kinds of fault; first each task without faults",
            "2 recetas, 1 tarea, 70 tipos de fallo; primero, cada tarea sin fallos",
        ),
        (
            "a run took 55 ms of a processor: 38 ms to judge 12.0 s of the plant, 13 ms to fork, 4 ms for "
            "what runs share; 14% ended early, as without the fault",
            "una ejecución ocupó un procesador 55 ms: 38 ms para juzgar 12.0 s de la planta, 13 ms para "
            "bifurcarse, 4 ms para lo que comparten; el 14% acabó antes, igual que sin el fallo",
        ),
        (
            "  the fault  ra_1: Cut its link (up, lost), for 3.000 s, then oven: It jams at 2.000 s",
            "  el fallo       ra_1: Cortar su enlace (up, lost), durante 3.000 s, después oven: Se atasca "
            "a los 2.000 s",
        ),
        (
            "bench shine: ra_1: It jams, for 3.000 s; just after the end of lamp: shining (2.100 s)",
            "bench shine: ra_1: Se atasca, durante 3.000 s; justo después del final de lamp: shining "
            "(2.100 s)",
        ),
    ],
)
def test_a_sentence_of_several_templates_is_whole(english: str, spanish: str) -> None:
    assert findings("es")(english) == spanish
