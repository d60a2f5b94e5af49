"""Extract of the answer of `arboleda prove`: what a page or an assistant is shown of it."""

from __future__ import annotations

from typing import Any

from ..proof.outcome import End

MOST = 40  # rows of each list


def shown(proof: dict[str, Any]) -> dict[str, Any]:
    """The part of an answer that the page shows; all of it is in the page of its own."""
    return {
        "complete": proof["complete"],
        "runs": proof["runs"],
        "alone": proof["alone"],
        "table": proof["table"],
        "findings": proof["findings"][:MOST],
        "mend": proof["mend"],
        "unsound": [each for each in proof["scenarios"] if not _is_sound(each["without_faults"])][:MOST],
        "tasks": [each["task"] for each in proof["scenarios"]],
        "unnoticed": proof["unnoticed"][:MOST],
        "breaches": proof["breaches"][:MOST],
    }


def _is_sound(outcome: dict[str, Any]) -> bool:
    return outcome["end"] == End.DONE.value and outcome["broken"] is None
