"""An assistant that asks a plant, by the client of the SDK, and what it is answered."""

from __future__ import annotations

import json
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager
from types import SimpleNamespace
from typing import Any

import pytest
from mcp import Client
from tests.web_plant import Plant

from arboleda.assistant.bench import Bench
from arboleda.assistant.envelope import NOTE
from arboleda.assistant.server import made
from arboleda.client import AsyncPlant
from arboleda.model.assistants import NO_LIMITS, Assistants


@pytest.fixture
def read(plant: Plant) -> Plant:
    """A plant whose file lets assistants look."""
    plant.model = SimpleNamespace(assistants=Assistants.READ, assistant_limits=NO_LIMITS)  # type: ignore[attr-defined]
    return plant


async def replied(client: Client, tool: str, **given: Any) -> dict[str, Any]:
    """The envelope of a reply, which is one text and the same as an object."""
    result = await client.call_tool(tool, given)
    assert not result.is_error and result.structured_content is not None
    assert json.loads(result.content[0].text) == result.structured_content  # type: ignore[union-attr]
    reply: dict[str, Any] = result.structured_content
    assert reply.keys() == {"note", "refused", "data"} and reply["note"] == NOTE
    return reply


@asynccontextmanager
async def in_process(origin: str, bench: Bench | None = None) -> AsyncIterator[Client]:
    """The assistant of the plant at this address."""
    async with Client(made(lambda _: AsyncPlant(origin, patience_s=0.0), bench)) as client:
        yield client
