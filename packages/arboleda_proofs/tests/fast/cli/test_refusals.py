"""Faults by hand from the command line, and what is refused of them."""

from __future__ import annotations

from typing import Any

import pytest
from tests.unit.cli.test_refusals import Typed
from tests.unit.cli.test_refusals import typed as typed

from arboleda.model.errors import ArboledaError
from arboleda_proofs.commands import fault

DONE: dict[str, Any] = {"robot": "ra1", "kind": "no_grip", "about": "Grip beside the part", "left_s": 600.0}


class Plant:
    """A plant that provokes what it is asked for, but at no device that it does not have."""

    def post(self, path: str, body: dict[str, Any], *, is_repeatable: bool = False) -> Any:
        if path == "/api/faults/end":
            return [DONE] if body["robot"] == "ra1" else []
        if body["robot"] != "ra1":
            raise ArboledaError(f"there is no device {body['robot']}; virtual ones are ra1")
        return {**DONE, "kind": body["kind"], "left_s": body.get("seconds")}

    def get(self, path: str) -> dict[str, Any]:
        return {"begun": [], "offers": [{**DONE, "lasts": True}]}


@pytest.mark.parametrize(
    ("words", "status", "sentence"),
    [
        (("no_grip", "ra1", "--for", "10m"), 0, "ra1: no_grip (Grip beside the part), for 600 s"),
        (("end", "ra1"), 0, "ra1: no_grip (Grip beside the part): ended"),
        ((), 0, "no fault goes on"),
        (("--list",), 0, "no_grip Grip beside the part: ra1"),
        (("no_grip",), 2, "which device?"),
        (("no_grip", "ra1", "--for", "soon"), 2, "'soon' is no time"),
        (("end", "--for", "5s"), 2, "--for is of a fault that begins"),
    ],
    ids=lambda value: " ".join(value) or "nothing" if isinstance(value, tuple) else "",
)
def test_a_fault_by_hand_is_said_or_refused(
    typed: Typed,
    monkeypatch: pytest.MonkeyPatch,
    words: tuple[str, ...],
    status: int,
    sentence: str,
) -> None:
    monkeypatch.setattr(fault, "client", lambda *_: Plant())
    ended, said = typed("fault", *words)
    assert (ended, sentence in said) == (status, True), said
