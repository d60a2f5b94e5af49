"""Requests of the page about faults at virtual devices."""

from __future__ import annotations

from fastapi.concurrency import run_in_threadpool

from arboleda.extension import ArboledaError, Request
from arboleda_proofs.running.faults_api import FaultsApi

BEGIN, END = "fault", "end_fault"


async def begin(request: Request) -> None:
    """Have a fault begin at the virtual device that is named."""
    desk, wanted = request.plant.ask(FaultsApi), request.more if isinstance(request.more, dict) else {}
    kind, seconds = str(wanted.get("kind", "")), wanted.get("seconds")
    if desk is None or not kind:
        return
    try:
        instant = {offer.kind for offer in desk.offers() if not offer.lasts}
        lasting = float(seconds) if isinstance(seconds, int | float) and kind not in instant else None
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
