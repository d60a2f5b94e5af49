"""Faults at virtual devices on the page: those that were provoked and go on, and requests about them."""

from __future__ import annotations

from fastapi.concurrency import run_in_threadpool

from arboleda.dashboard.faces.moment import seconds
from arboleda.extension import ArboledaError, Face, Moment, Request
from arboleda_proofs.running.api import FaultsApi

BEGIN, END = "fault", "end_fault"


def face(moment: Moment) -> Face:
    begun = moment.links.get("faults", ())
    found: Face = {"rows/faults": [str(each["number"]) for each in begun]}
    for each in begun:
        about = moment.words.say(each["about"])
        offer = {
            "act": END,
            "of": str(each["number"]),
            "label": moment.words("faults.end"),
            "does": moment.words("faults.end_does", what=about, robot=each["robot"]),
        }
        left = moment.words("faults.left", time=seconds(each["left_s"]))
        found[f"row/faults/{each['number']}"] = {
            "state": "held",
            "texts": [f"{each['robot']}: {about} ({left})"],
            "acts": [offer],
        }
    return found


async def begin(request: Request) -> None:
    """Have a fault begin at the virtual device that is named."""
    desk, wanted = request.plant.ask(FaultsApi), request.more if isinstance(request.more, dict) else {}
    kind, wished_s = str(wanted.get("kind", "")), wanted.get("seconds")
    if desk is None or not kind:
        return
    try:
        instant = {offer.kind for offer in desk.offers() if not offer.lasts}
        lasting = float(wished_s) if isinstance(wished_s, int | float) and kind not in instant else None
        begun = await run_in_threadpool(desk.begin, kind, request.of, lasting)
        request.say(f"{begun.robot}: {request.words.say(begun.about)}", good=True)
    except ArboledaError as error:
        request.say(request.words.say(error.sentence), good=False)


async def end(request: Request) -> None:
    """End the fault of the number that is named."""
    desk = request.plant.ask(FaultsApi)
    if desk is None or not request.of.isdecimal():
        return
    try:
        await run_in_threadpool(desk.end, "", int(request.of))
        request.say(request.words("faults.ended"), good=True)
    except ArboledaError as error:
        request.say(request.words.say(error.sentence), good=False)
