"""Level of assistants, as the plant file has it."""

from __future__ import annotations

from typing import Literal

from fastapi import APIRouter
from fastapi.responses import JSONResponse
from pydantic import Field

from arboleda.model.assistants import Assistants

from ..plant_api import PlantApi
from ..schema.bodies import ResponseModel
from ..schema.plain_json import PlainJson


class AssistantLevel(ResponseModel):
    """Level of assistants, `assistants` of the plant file."""

    level: Literal["off", "read", "propose", "submit"] = Field(
        description="off: nothing. read: look, and stop. propose, submit: the same and more."
    )
    cells: list[str] = Field(description="Those to which they may give tasks.")
    at_once: int = Field(description="How many of their tasks may be open.")
    hours: str | None = Field(description="The hours of the day in which they may; null: at any time.")


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/assistants", response_model=AssistantLevel)
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
