"""Findings of proofs and boards are said in every language."""

from __future__ import annotations

import pytest
from tests.meta.test_found_in_every_language import said

from arboleda.dashboard.findings import findings
from arboleda.web.languages import LANGUAGES
from arboleda_boards.conformance.judge import CHECKS, DEVICE_CHECKS
from arboleda_proofs.simulator.faults import KINDS


@pytest.mark.parametrize("language", LANGUAGES[1:])
def test_what_a_check_wants_of_a_board_has_its_twin(language: str) -> None:
    wanted = {(each.steps.__doc__ or "").strip() for each in (*CHECKS, *DEVICE_CHECKS)}
    assert wanted - said(language) == set(), f"say these in {language}/findings.yaml"


@pytest.mark.parametrize("language", LANGUAGES[1:])
def test_a_kind_of_fault_is_explained(language: str) -> None:
    alone = [each.name for each in KINDS.values() if findings(language)(each.sentence) == each.sentence]
    assert alone == [], f"say their docstrings in {language}/findings.yaml"
