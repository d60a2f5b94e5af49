"""The HTTP API of one plant, with short limits of time for each request."""

from __future__ import annotations

import asyncio
from typing import Any

import httpx

from arboleda.client.protocol import COMMAND_LINE
from arboleda.drivers import plain, text_of_error
from arboleda.extension import ArboledaError, Phrase
from arboleda.runtime.endpoints import Place

ANSWER_S = 2.5  # a browser gives a stop up after 3 s
LONGEST = 300  # characters of what a plant says that are shown

NOBODY_LEADS = Phrase("site.nobody_leads", "nobody leads this plant")
NO_ANSWER = Phrase("site.no_answer", "no answer in {seconds:g} s")
NOT_REACHED = Phrase("site.not_reached", "{url} cannot be reached ({error})")
NO_PLANT = Phrase("site.no_plant", "what answers at {url} is no plant")
REFUSED = Phrase("site.refused", "it answers {status}: {said}")


class PlantSilent(ArboledaError):
    """A plant gave no usable answer; the sentence is the reason."""


class PlantRefusal(ArboledaError):
    """A plant refused a request, in its own words."""


class Reach:
    """Reach: one address; PlantSilent if it gives no answer, PlantRefusal if it refuses."""

    def __init__(self, place: Place) -> None:
        self.place = place
        headers = {"user-agent": COMMAND_LINE}
        if place.token:
            headers["authorization"] = f"Bearer {place.token}"
        self._http = httpx.AsyncClient(
            trust_env=False,
            timeout=ANSWER_S,
            headers=headers,
            verify=place.believed(),
            follow_redirects=False,
        )

    async def get(self, path: str) -> Any:
        """The answer of the plant to a GET of that path."""
        return await self._request("GET", path, None)

    async def post(self, path: str, body: dict[str, Any] | None = None) -> Any:
        return await self._request("POST", path, body)

    async def close(self) -> None:
        await self._http.aclose()

    async def _request(self, method: str, path: str, body: dict[str, Any] | None) -> Any:
        url = self.place.url
        if not url:
            raise PlantSilent(NOBODY_LEADS())
        try:
            request = self._http.request(method, f"{url}{path}", json=body)
            answer = await asyncio.wait_for(request, ANSWER_S)
            content = answer.json()
        except (asyncio.TimeoutError, httpx.TimeoutException) as error:
            raise PlantSilent(NO_ANSWER(seconds=ANSWER_S)) from error
        except httpx.HTTPError as error:
            raise PlantSilent(NOT_REACHED(url=url, error=text_of_error(error)[:LONGEST])) from error
        except ValueError as error:
            raise PlantSilent(NO_PLANT(url=url)) from error
        if answer.is_success:
            return content
        sentence = plain(str(content.get("sentence", "") if isinstance(content, dict) else ""))[:LONGEST]
        if sentence and answer.status_code in (404, 409, 422):
            raise PlantRefusal(sentence)
        raise PlantSilent(REFUSED(status=answer.status_code, said=sentence))
