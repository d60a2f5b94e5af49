"""Desk of an assistant: answers its calls as the plant file lets it, each with a client of the plant."""

from __future__ import annotations

from collections.abc import Awaitable, Callable
from typing import Any, Protocol

from mcp.server.mcpserver import Context
from mcp.types import ToolAnnotations

from arboleda.client import AsyncPlant
from arboleda.drivers import plain
from arboleda.extension import ArboledaError

from .envelope import answered, refused

OFF = (
    "The plant file does not let assistants look: a person can write `assistants: read` into it, and start"
    " the plant anew."
)
Call = Context[Any, Any]
Reply = dict[str, Any]
Reach = Callable[[Call], AsyncPlant]
Tools = list[tuple[Callable[..., Awaitable[Reply]], ToolAnnotations]]
"""Tools of a group, each with what it does to the plant."""


def hints(*, looks: bool = False, moves: bool = False, repeats: bool = True) -> ToolAnnotations:
    """Hints for the assistant's program: whether a tool only `looks`, `moves` something or ends its move, and
    whether calling it twice is as calling it once."""
    if looks:
        return ToolAnnotations(read_only_hint=True, open_world_hint=False)
    return ToolAnnotations(
        read_only_hint=False, destructive_hint=moves, idempotent_hint=repeats, open_world_hint=False
    )


LOOK, PROPOSE = hints(looks=True), hints()
STOP, GIVE = hints(moves=True), hints(moves=True, repeats=False)


class ToolGroup(Protocol):
    """Group of tools of one subject."""

    def tools(self) -> Tools:
        """All of them, with their hints."""


class NotAllowed(ArboledaError):
    """The plant file does not allow it."""


class Desk:
    """Desk: answers the calls of an assistant; `reach` makes a client of the plant for each of them."""

    def __init__(self, reach: Reach) -> None:
        self._reach = reach

    async def look(self, call: Call, act: Callable[[AsyncPlant], Awaitable[Any]]) -> Reply:
        """The reply of `act`, where the plant file lets assistants look; else why not."""

        async def allowed(plant: AsyncPlant) -> Any:
            if (await plant.assistants()).level == "off":
                raise NotAllowed(OFF)
            return await act(plant)

        return await self.always(call, allowed)

    async def always(self, call: Call, act: Callable[[AsyncPlant], Awaitable[Any]]) -> Reply:
        """The reply of `act`, whatever the plant file says."""
        try:
            async with self._reach(call) as plant:
                return answered(await act(plant))
        except ArboledaError as error:
            return refused(error)


def program_of(call: Call) -> str:
    """The name that an assistant's program says of itself, as far as it can be shown."""
    about = call.session.client_params
    return plain(about.client_info.name if about else "", 60) or "assistant"
