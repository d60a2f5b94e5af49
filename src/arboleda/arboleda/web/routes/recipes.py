"""Recipes that each cell offers."""

from __future__ import annotations

from fastapi import APIRouter
from fastapi.responses import JSONResponse

from arboleda.client.answers.offers import Offer

from ..plant_api import PlantApi
from ..schema.plain_json import PlainJson
from ..schema.queries import answering


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/recipes", **answering(list[Offer]))
    async def recipes() -> JSONResponse:
        """The recipes of each cell, their parameters, and the values that these can have."""
        return PlainJson(side.offers())

    return api
