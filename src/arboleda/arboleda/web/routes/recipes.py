"""Recipes that each cell offers."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import JSONResponse
from pydantic import Field

from ..plant_api import PlantApi
from ..schema.bodies import ResponseModel
from ..schema.plain_json import PlainJson


class Parameter(ResponseModel):
    """Parameter of a recipe; more types may be added."""

    name: str
    called: str = Field(description="Its name for people.")
    type: str = Field(description="`choice`: one of its `choices`; `integer`, `number`: within its limits.")
    choices: list[str]
    lower: float | None = None
    upper: float | None = None


class Recipe(ResponseModel):
    name: str
    about: str = Field(description="What it does, in a line.")
    default: bool = Field(description="A task that names no recipe means this one.")
    form: str = Field(examples=["<cell> <path> <station>"], description="How its task text is written.")
    example: str = Field(examples=["sis_a 0A 8"])
    parameters: list[Parameter]


class Offer(ResponseModel):
    cell: str
    recipes: list[Recipe]


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/recipes", response_model=list[Offer])
    async def recipes() -> JSONResponse:
        """The recipes of each cell, their parameters, and the values that these can have."""
        return PlainJson(side.offers())

    return api
