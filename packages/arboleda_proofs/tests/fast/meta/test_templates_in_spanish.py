"""Names of faults and mishaps in Spanish."""

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
