"""The strategies draw task texts, or faults, of the plant."""

from __future__ import annotations

from hypothesis import given

from arboleda.model.text import parse
from arboleda.testing import shipped
from arboleda_proofs.simulator.faults import KINDS, Fault
from arboleda_proofs.testing.strategies import faults, tasks

PLANT = shipped("sis_a", "sis_c")


@given(tasks(PLANT))
def test_every_task_text_is_taken(text: str) -> None:
    assert parse(text, PLANT).cell in ("sis_a", "sis_c")


@given(faults(PLANT, within_s=5.0))
def test_every_fault_can_happen(fault: Fault) -> None:
    assert KINDS[fault.kind].objection(fault, PLANT) is None
    assert fault.at <= 5.0
    assert KINDS[fault.kind].weight > 0
