"""Rules of invariants in Spanish."""

from __future__ import annotations

import pytest
from tests.unit.cli.test_findings_language import SENTENCES

from arboleda.dashboard.findings import findings
from arboleda_proofs.campaigns.setting import rules


@pytest.mark.parametrize("rule", list(rules().values()), ids=list(rules()))
def test_the_rule_of_an_invariant_is_said_in_spanish(rule: str) -> None:
    assert findings("es")(f"  must hold  {rule}") == f"  debe cumplirse {SENTENCES[rule]}"
