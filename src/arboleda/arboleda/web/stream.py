"""Changes of the plant, as server-sent events."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from typing import Annotated, Any

from fastapi import APIRouter, Header, Request
from fastapi.responses import StreamingResponse
from starlette.exceptions import HTTPException

from . import limits
from .changes import Changes
from .plant_api import PlantApi

ABOUT: dict[int | str, dict[str, Any]] = {
    200: {
        "description": "A stream. `snapshot` is the whole plant; `plant`, `cell`, `robot`, `task` and "
        "`zone` are each one row of it that changed. With `Last-Event-ID` it goes on after that event, if it "
        "still can. A reader that does not keep up is cut off.",
        "content": {"text/event-stream": {"schema": {"type": "string"}}},
    }
}


def routes(side: PlantApi, most: int) -> APIRouter:
    """`GET /api/events`, for at most so many readers at a time."""
    api = APIRouter(prefix="/api")
    changes = Changes(side)

    @api.get("/events", response_class=StreamingResponse, responses=ABOUT)
    async def events(request: Request, last_event_id: Annotated[str, Header()] = "") -> StreamingResponse:
        """Changes as they happen (server-sent events)."""
        if len(changes) >= most:
            sentence = f"No more than {most} may listen at a time; close one."
            raise HTTPException(503, sentence, {"retry-after": limits.LATER_S})
        told = tell(changes, last_event_id, request.scope["arboleda.login"].alive)
        return StreamingResponse(told, media_type="text/event-stream", headers={"x-accel-buffering": "no"})

    return api


async def tell(changes: Changes, last: str, alive: Callable[[], bool]) -> AsyncIterator[str]:
    """Events as text, and a comment after a while without any, until the reader is too slow or logged out."""
    reader = changes.listen(last)
    try:
        while alive():
            try:
                event = await asyncio.wait_for(reader.next(), limits.BEAT_S)
            except asyncio.TimeoutError:
                yield ": still here\n\n"
                continue
            if event is None or not alive():
                return
            yield event.text
    finally:
        changes.leave(reader)
