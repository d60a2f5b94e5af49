"""Welcome to the visitors of a demonstration: three lines, and the button that ends it."""

from __future__ import annotations

from arboleda.dashboard.faces import Face
from arboleda.dashboard.faces.moment import Moment
from arboleda.dashboard.page_part import Request, Spot
from arboleda.dashboard.tags import live, tag
from arboleda_proofs.running.demonstration_api import DemonstrationApi

END = "end_demo"
LINES = ("cells", "trouble", "more")


def build(spot: Spot) -> None:
    """Draw the welcome: its lines stay until they were read, the button until the demonstration ends."""
    words = spot.words
    if spot.plant.ask(DemonstrationApi) is None:
        return
    with tag("aside", id="demo", aria_label=words("demo.title")):
        live("span", "demo", hidden="true")
        tag("p", words("demo.title"), classes="demo-title")
        with tag("ol", id="demo-lines", hidden="true"):
            for line in LINES:
                tag("li", words(f"demo.{line}"))
        with tag("div", classes="demo-acts"):
            tag("button", words("demo.seen"), type="button", id="demo-seen", classes="act", hidden="true")
            does = words("demo.end_does")
            tag("button", words("demo.end"), type="button", id="demo-end", classes="act", title=does)


def face(moment: Moment) -> Face:
    """Whether it goes on."""
    return {"text/demo": ["", "on" if moment.links.get("demo") else "off"]}


async def end(request: Request) -> None:
    """End it, as a visitor asks."""
    demonstration = request.plant.ask(DemonstrationApi)
    if demonstration is not None:
        demonstration.end()
    request.say(request.words("demo.ended"), good=True)
