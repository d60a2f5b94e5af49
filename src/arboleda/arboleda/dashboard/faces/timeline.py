"""The time line."""

from __future__ import annotations

from typing import Any

from . import Face
from .moment import Moment, dated

SHOWN = 200  # events; the download has all that are kept
Event = dict[str, Any]


def face(moment: Moment) -> Face:
    """The rows of the time line, the newest event first."""
    last = list(moment.events)[-SHOWN:][::-1]
    found: Face = {"rows/events": [str(event["number"]) for event in last]}
    for event in last:
        found[f"row/events/{event['number']}"] = row(moment, event)
    return found


def row(moment: Moment, event: Event) -> dict[str, Any]:
    words = moment.words
    return {
        "state": event["what"],
        "cell": event["cell"] or "",
        "texts": [
            dated(event["at"], moment.unix_s),
            event["cell"] or words("events.plant"),
            words(f"events.{event['kind']}", subject=event["subject"], what=_what(moment, event)),
            words.say(event["sentence"]),
        ],
    }


def _what(moment: Moment, event: Event) -> str:
    if event["kind"] == "robot":
        return moment.words(f"links.{event['what']}")
    return moment.words.of(f"{event['kind']}_state", event["what"])
