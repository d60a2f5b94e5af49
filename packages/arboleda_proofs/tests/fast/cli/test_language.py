"""Faults by hand, said in the language of the terminal."""

from __future__ import annotations

from tests.unit.cli.test_language import spanish as spanish

from arboleda.cli.language import say_error, say_row
from arboleda.client.errors import Conflict
from arboleda.model.errors import ArboledaError
from arboleda_proofs.running.fault_desk import AN_INSTANT


def test_errors_of_this_process_and_of_a_plant_are_said_in_it(spanish: None) -> None:
    said = "lost_part termina al instante: no indique cuánto dura"
    sentence = AN_INSTANT(kind="lost_part")
    assert say_error(ArboledaError(sentence)) == said
    assert say_error(Conflict(409, {"sentence": str(sentence), **sentence.data()})) == said
    assert say_error(ArboledaError("in words of its own")) == "in words of its own"
    assert say_error(Conflict(409, {"sentence": "of a later version", "key": "x.y", "values": {}})) == (
        "of a later version"
    )


def test_a_task_is_told_in_it(spanish: None) -> None:
    sentence = AN_INSTANT(kind="jam")
    assert say_row({"sentence": str(sentence), **sentence.data()}).startswith("jam termina al instante")
    assert say_row({"sentence": None}) == ""
    assert say_row({"sentence": "broken", "key": "fault.an_instant", "values": {"kind": None}}) == "broken"
