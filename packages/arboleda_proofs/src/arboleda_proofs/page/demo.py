"""Welcome to the visitors of a demonstration, which goes by itself, and the button that ends it."""

from __future__ import annotations

from arboleda.extension import Face, Moment, Request, Spot, tag
from arboleda_proofs.running.api import DemonstrationApi

END = "end_demo"
LINES = ("cells", "trouble", "more")


def welcome(spot: Spot) -> None:
    """Draw what a visitor reads once: three lines on what to press."""
    words = spot.words
    if spot.plant.ask(DemonstrationApi) is None:
        return
    labels = {"ready": "ready.cell", "operate": "panel.title", "fault": "faults.title"}
    buttons = {name: words(key) for name, key in labels.items()}
    with tag("aside", id="demo", aria_label=words("demo.title"), hidden="true"):
        close = words("demo.seen")
        tag("button", "×", type="button", id="demo-seen", classes="tool", title=close, aria_label=close)  # noqa: RUF001
        tag("p", words("demo.title"))
        with tag("ol"):
            for line in LINES:
                tag("li", words(f"demo.{line}", **buttons))


def end_of_it(spot: Spot) -> None:
    """Draw the button that ends the demonstration, in the menu of the plant."""
    words = spot.words
    if spot.plant.ask(DemonstrationApi) is None:
        return
    with tag("div", id="demo-on", classes="box", hidden="true"):
        tag("p", words("demo.title"))
        does = words("demo.end_does")
        with tag("div"):
            tag("button", words("demo.end"), type="button", id="demo-end", classes="act", title=does)


def face(moment: Moment) -> Face:
    """The word of the demonstration: on while it goes on."""
    return {"text/demo": ["", "on" if moment.links.get("demo") else "off"]}


async def end(request: Request) -> None:
    """End it, as a visitor asks."""
    demonstration = request.plant.ask(DemonstrationApi)
    if demonstration is not None:
        demonstration.end()
    request.say(request.words("demo.ended"), good=True)
