"""Level of assistants, as the plant file has it."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import JSONResponse

from arboleda.client.answers.offers import AssistantLevel
from arboleda.model.assistants import Assistants

from ..plant_api import PlantApi
from ..schema.plain_json import PlainJson
from ..schema.queries import answering


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/assistants", **answering(AssistantLevel))
    async def assistants() -> JSONResponse:
        """The level of assistants, over `arboleda mcp`, in the plant file, and the limits of their tasks."""
        limits = side.model.assistant_limits
        is_let = side.model.assistants is Assistants.SUBMIT
        return PlainJson(
            {
                "level": side.model.assistants.value,
                "cells": list(limits.cells),
                "at_once": limits.at_once if is_let else 0,
                "hours": None if limits.hours is None else limits.hours.text,
            }
        )

    return api
