"""The line below the card of each cell."""

from arboleda.extension import PagePart, Place, Section, live

from . import ENDED


def card(spot):
    live("p", f"{spot.cell}.ended")


def face(moment):
    counts = moment.links.get("ended", {}).get("counts", {})
    return {
        f"text/{cell}.ended": [moment.words.say(ENDED(count=count)), ""] for cell, count in counts.items()
    }


PAGE = PagePart(sections=(Section(place=Place.CARD, build=card),), face=face)
