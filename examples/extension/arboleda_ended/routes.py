"""The route that tells how many tasks ended."""

from fastapi import APIRouter

from .part import EndedTasks


def routes(side):
    api = APIRouter(prefix="/api")

    @api.get("/ended")
    async def ended() -> dict[str, int]:
        """How many tasks ended in each cell, in all starts."""
        part = side.ask(EndedTasks)
        return part.counts if part else {}

    return api
