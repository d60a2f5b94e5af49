"""The playground's page: the parts of the page of a plant, what can go wrong, and the bar of its time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from arboleda.dashboard.body import script_data
from arboleda.dashboard.lone_page import lone_page
from arboleda.extension import Layout, Words, rows, tag, words
from arboleda.web.languages import texts
from arboleda_proofs.page import fault_form
from arboleda_proofs.simulator.mishaps import MISHAPS

from . import strip

SPEEDS = ("0.25", "1", "4", "16")
TOOLS = {"begin": "«", "back": "‹", "play": "▶", "step": "›"}  # noqa: RUF001 - as signs on buttons
Targets = Mapping[str, Mapping[str, Any]]


class PlayWords:
    """PlayWords: the playground's own texts in one language, in English where it has none."""

    def __init__(self, language: str) -> None:
        self._texts = texts(language, "playground")

    def __call__(self, key: str) -> str:
        return self._texts[key]

    def plant(self, name: str) -> str:
        """The name of a plant, and what it is."""
        return f"{name}: {self._texts[f'plant_{name}']}"


def data(language: str) -> dict[str, Any]:
    """Data of the page's scripts, `window.arboledaPage`, with the few words of the playground's own."""
    made = script_data(words(language))
    own = {key: text for key, text in texts(language, "playground").items() if key.startswith("js_")}
    return {**made, "words": {**made["words"], **own}}


def html(layout: Layout, language: str, *, plants: list[str], chosen: str, targets: Targets) -> str:
    """The page of a plant; `plants` are those to choose from, `targets` whom which mishap can befall; either
    is not offered where there is none."""
    wording, own = words(language), PlayWords(language)
    return lone_page(layout, wording, lambda: _below(wording, own, plants, chosen, targets))


def _below(wording: Words, own: PlayWords, plants: list[str], chosen: str, targets: Targets) -> None:
    with tag("section", id="play", classes="play", aria_label=own("bar")):
        if targets:
            with tag("details", id="play-mishaps", classes="play-mishaps"):
                tag("summary", wording("faults.title"))
                with tag("div", classes="play-faults"):
                    fault_form.form(wording, _targets(own, targets))
        rows(strip.LIST, [""], classes="play-happened")
        _time(wording, own)
        if plants:
            _plants(own, plants, chosen)


def _plants(own: PlayWords, plants: list[str], chosen: str) -> None:
    with tag("div", classes="play-plant"):
        with tag("label", classes="play-plant"):
            tag("span", own("plant"))
            with tag("select", id="play-plant", classes="tool"):
                for name in plants:
                    tag("option", own.plant(name), value=name, **_selected(on=name == chosen))
        tag("a", own("edit"), id="play-edit", href=f"workbook.html?plant={chosen}", title=own("edit_why"))


def _targets(own: PlayWords, possible: Targets) -> list[fault_form.Target]:
    return [
        fault_form.Target(
            name=each["target"],
            label=strip.named(own, name),
            kinds={kind: MISHAPS[kind].sentence for kind in each["mishaps"]},
        )
        for name, each in possible.items()
    ]


def _time(wording: Words, own: PlayWords) -> None:
    with tag("div", classes="play-time"):
        for name, sign in TOOLS.items():
            does = own(name)
            tag("button", sign, type="button", classes="tool", data_play=name, title=does, aria_label=does)
        with tag("select", id="play-speed", classes="tool", aria_label=wording("record.speed")):
            for speed in SPEEDS:
                text = wording("record.times", speed=speed)
                tag("option", text, value=speed, **_selected(on=speed == "1"))
        tag("output", id="play-clock", classes="play-clock")
    with tag("div", classes="play-span"):
        tag("div", id="play-marks", classes="record-marks", aria_hidden="true")
        ends = {"min": "0", "max": "1", "step": "1", "value": "0"}
        tag("input", id="play-slider", type="range", aria_label=own("slider"), **ends)


def _selected(*, on: bool) -> dict[str, str]:
    return {"selected": "true"} if on else {}
