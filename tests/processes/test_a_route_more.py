"""A route is added by its module, its row, and a method of `PlantApi` that the plant answers which runs."""

from __future__ import annotations

from pathlib import Path

from .copied_tree import CopiedTree

ROUTE = '''"""Tasks that wait in all cells."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from fastapi import APIRouter
from fastapi.responses import JSONResponse

from ..schema.plain_json import PlainJson
from ..schema.queries import answering
from ..plant_api import PlantApi


@dataclass(frozen=True, kw_only=True)
class Waiting:
    """Tasks that wait."""

    waiting: Annotated[int, "How many tasks wait."]


def routes(side: PlantApi) -> APIRouter:
    """Register the route."""
    api = APIRouter(prefix="/api")

    @api.get("/waiting", **answering(Waiting))
    async def waiting() -> JSONResponse:
        """The number of tasks that wait."""
        return PlainJson({"waiting": side.waiting()})

    return api
'''
METHOD = '''    def waiting(self) -> int:
        """The number of tasks that wait."""
        return self.read(lambda plant: sum(len(run.queue) for run in plant.cells.values()))

'''
LOOK = r"""
import asyncio, httpx, json, types
from arboleda.runtime.parts.local_plant import LocalPlant
from arboleda.testing.plants import shipped
from arboleda.rig.rig import Rig
from arboleda.web.api import make_app
from arboleda.web.schema.openapi import render

rig = Rig(shipped())
for text in ("sis_a 0B 7", "sis_a 1C 2", "sis_a 0B 3"):
    rig.submit(text)
loop = types.SimpleNamespace(read=lambda look: look(rig.plant))
app = make_app(LocalPlant(types.SimpleNamespace(plant=rig.plant, loop=loop), None))

async def go(app, method, path, headers):
    async with httpx.AsyncClient(transport=httpx.ASGITransport(app=app), base_url="http://plant") as client:
        return await client.request(method, path, headers=headers)

def ask(app, method, path, **headers):
    return asyncio.run(go(app, method, path, headers))

wrong = ask(app, "POST", "/api/waiting")
print(json.dumps({
    "answer": ask(app, "GET", "/api/waiting").json(),
    "wrong": [wrong.status_code, wrong.headers["allow"]],
    "schema": render(app.openapi()),
}))
"""


def test_a_route_takes_a_file_a_row_and_a_method_and_answers_of_the_plant(tmp_path: Path) -> None:
    tree = CopiedTree(tmp_path)
    tree.add("web/routes/waiting.py", ROUTE)
    tree.insert("web/routes/__init__.py", '"promises",', '"waiting", ')
    tree.insert("web/plant_api.py", "    def promises(self, text: str)", METHOD)
    assert len(tree.changed) == 3
    seen = tree.run(LOOK)
    assert seen["answer"] == {"waiting": 2}
    assert seen["wrong"] == [405, "GET"]
    assert "GET /api/waiting" in seen["schema"] and "How many tasks wait." in seen["schema"]
