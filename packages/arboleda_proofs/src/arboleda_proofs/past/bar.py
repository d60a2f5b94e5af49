"""The bar of a record: its time, a slider over all of it, and the ways to other moments."""

from __future__ import annotations

from arboleda.extension import Layout, Words, live, tag

SPEEDS = (1, 4, 16, 64)
BEFORE = {"failure_before": "‹ ✕", "event_before": "‹"}  # noqa: RUF001 - as signs on buttons
AFTER = {"event_after": "›", "failure_after": "✕ ›"}  # noqa: RUF001
PLAY = "▶"


def build(layout: Layout, words: Words, scene: str) -> None:
    """Draw the bar, which says from which address the script of the twin has its scene."""
    with tag("section", id="record", classes="record", aria_label=words("record.label"), data_scene=scene):
        with tag("div", classes="record-when"):
            tag("span", words("record.was"), classes="record-was")
            live("time", "record.at", classes="record-at")
            live("span", "record.event", classes="record-event")
        with tag("div", classes="record-span"):
            tag("div", id="record-marks", classes="record-marks", aria_hidden="true")
            tag(
                "input",
                id="record-slider",
                type="range",
                min="0",
                max="1",
                step="1",
                value="0",
                aria_label=words("record.slider"),
            )
        with tag("div", classes="record-tools"):
            _ways(BEFORE, words)
            play = words("record.play")
            tag("button", PLAY, type="button", id="record-play", classes="tool", title=play, aria_label=play)
            _ways(AFTER, words)
            _speed(words)
            _of(layout, words)
            tag("select", id="record-start", classes="tool", aria_label=words("record.start"), hidden="true")


def _ways(ways: dict[str, str], words: Words) -> None:
    for name, sign in ways.items():
        does = words(f"record.{name}")
        tag("button", sign, type="button", classes="tool", data_past=name, title=does, aria_label=does)


def _speed(words: Words) -> None:
    with tag("select", id="record-speed", classes="tool", aria_label=words("record.speed")):
        for speed in SPEEDS:
            tag("option", words("record.times", speed=speed), value=str(speed))


def _of(layout: Layout, words: Words) -> None:
    """Draw the choice of the cell through whose events the buttons step."""
    with tag("select", id="record-cell", classes="tool", aria_label=words("record.of")):
        tag("option", words("page.all"), value="")
        for cell in layout["cells"]:
            tag("option", cell["name"], value=cell["name"])
