"""`GET /metrics`, for Prometheus."""

from __future__ import annotations

from collections.abc import Callable

from fastapi import APIRouter
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import PlainTextResponse

from .request import METRICS

TEXT = "text/plain; version=0.0.4; charset=utf-8"


def routes(text: Callable[[], bytes]) -> APIRouter:
    """Register the route; `text` may wait for the plant."""
    api = APIRouter()

    @api.get(METRICS, response_class=PlainTextResponse)
    async def metrics() -> PlainTextResponse:
        """Counts and states in the text format of Prometheus."""
        return PlainTextResponse(await run_in_threadpool(text), media_type=TEXT)

    return api
