"""Facts of a report as plain data: what the page shows, for programs. Times in s since the failure."""

from __future__ import annotations

import math
from typing import Any

from arboleda.extension import Sentence
from arboleda.model.sentence import OWN
from arboleda_proofs.playback.cause import Cause
from arboleda_proofs.playback.incident import Incident


def facts(found: Incident, cause: Cause | None) -> dict[str, Any]:
    """The facts of a task; why it failed, if it did."""
    of_task = {
        "task": found.task,
        "text": found.text,
        "cell": found.cell,
        "ended_s": found.unix_ns / 1e9,
        "chapters": [  # without their pictures, which are in the page
            {
                "package": each.package,
                "title": each.title,
                "text": each.text,
                "rows": [[*row] for row in each.rows],
                "picture": each.picture_type,
            }
            for each in found.chapters
        ],
    }
    return of_task if cause is None else {**of_task, **_of_failure(found, cause)}


def _of_failure(found: Incident, cause: Cause) -> dict[str, Any]:
    """The cause of a failure, and the evidence for it."""
    assert found.failure is not None
    zero = found.failed_at or found.ended_at or 0.0
    last = found.evidence.last
    accepted_at = None if last is None else last.accepted_at
    return {
        "reason": found.failure.reason.value,
        "failure": _sentence_row(found.failure.sentence),
        "cause": {"kind": cause.kind, "robot": cause.robot, **_sentence_row(cause.sentence)},
        "evidence": {
            "troubles": [
                {
                    "at_s": each.at - zero,
                    "robot": each.robot,
                    "kind": each.kind,
                    "seconds": None if each.seconds == math.inf else each.seconds,
                    "cut": each.cut,
                }
                for each in found.troubles
                if each.ends >= found.began_at
            ],
            "last_command": None
            if last is None
            else {
                "at_s": last.at - zero,
                "robot": last.robot,
                "id": last.id,
                "accepted_after_s": None if accepted_at is None else accepted_at - last.at,
            },
            "absences": [{"at_s": at - zero, "seconds": seconds} for at, seconds in found.absences],
            "acts": [{"at_s": at - zero, "words": words} for at, words in found.acts],
            "foreign": [{"at_s": at - zero, "robot": robot} for at, robot in found.foreign],
        },
    }


def _sentence_row(sentence: Sentence | str) -> dict[str, Any]:
    """A sentence as its text, and as data where it is more than a text."""
    data = sentence.data() if isinstance(sentence, Sentence) and sentence.phrase is not OWN else {}
    return {"sentence": str(sentence), "key": data.get("key"), "values": data.get("values")}
