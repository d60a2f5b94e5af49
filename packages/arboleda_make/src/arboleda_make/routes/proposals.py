"""Proposals of assistants, what people decide on them, and the tasks that assistants give."""

from __future__ import annotations

from typing import Annotated, Any

from fastapi import APIRouter, Path, Request
from fastapi.concurrency import run_in_threadpool
from fastapi.responses import JSONResponse
from pydantic import Field
from starlette.exceptions import HTTPException

from arboleda.client import Task
from arboleda.extension import PlantApi, Role, needs
from arboleda.model.sentence import explained
from arboleda.web.schema.bodies import BodyModel
from arboleda.web.schema.plain_json import PlainJson
from arboleda.web.schema.queries import answering, described_body, read_body
from arboleda_make.answers.drafts import RunState
from arboleda_make.answers.proposals import (
    DecidedProposal,
    ProposalAnswer,
    ProposalBase,
    ProposalRow,
    WholeProposal,
)
from arboleda_make.proposals.api import ProposalsApi
from arboleda_trees.bt_xml.markup import LARGEST

from .draft import REFUSED, SHIPPED, TREES, Key

PROPOSE = [needs(Role.ASSISTANT, "proposing"), TREES]
GIVE = [needs(Role.ASSISTANT, "giving a task as an assistant")]
DECIDE = [needs(Role.OPERATOR, "deciding on a proposal")]
Hash = Annotated[str, Path(pattern="^[0-9a-f]{64}$")]
Word = Annotated[str, Field(pattern="^[a-z][a-z0-9_]{0,39}$")]
Person = Annotated[str, Field(min_length=1, max_length=60)]
PlacePath = Annotated[list[Key], Field(min_length=1, max_length=20)]


class ProposedValue(BodyModel):
    """Value of the plant file, by its place: a target, a new device, a new kind."""

    place: PlacePath = Field(examples=[["cells", "lab", "targets", "nest"]])
    value: Any


class NewProposal(BodyModel):
    """Content that an assistant proposes, with its own words beside it."""

    name: Word = Field(description="Of the piece of work: a later proposal of this name takes its place.")
    by: Person = Field(description="The program of the assistant.", examples=["claude-code"])
    words: str = Field(default="", max_length=4000)
    trees: dict[Annotated[str, Field(max_length=200)], Annotated[str, Field(max_length=LARGEST)] | None] = (
        Field(
            default={}, max_length=20, description="Texts of files of trees; null: the plant uses it no more."
        )
    )
    values: list[ProposedValue] = Field(default=[], max_length=200)
    removed: list[PlacePath] = Field(default=[], max_length=200, description="Targets that go.")
    recipes: list[Word] = Field(
        default=[],
        max_length=50,
        description="Recipes of which it asks to give tasks, as they would be then.",
    )


class ProofRequest(BodyModel):
    recipes: list[Word] = Field(default=[], max_length=50, description="None named: all.")
    budget_s: float = Field(default=60, ge=1, le=600)


class SimulationRequest(BodyModel):
    seeds: int = Field(default=5, ge=1, le=50, description="Each draws other faults.")
    cycles: int = Field(default=4, ge=1, le=20, description="Tasks of each seed.")


class Approval(BodyModel):
    name: Person = Field(description="Of the person who approves, for the journal.", examples=["Ana"])


class Rejection(Approval):
    reason: str = Field(min_length=1, max_length=1000, description="The assistant reads it.")


class AssistantTask(BodyModel):
    text: str = Field(min_length=1, max_length=1000, examples=["lab to_tray #lot42"])
    by: Person


def routes(side: PlantApi) -> APIRouter:
    """Register the routes."""
    api = APIRouter(prefix="/api", dependencies=PROPOSE)
    _look(api, side)
    _propose(api, side)
    _decide(api, side)
    return api


def _look(api: APIRouter, side: PlantApi) -> None:
    @api.get("/proposals", **answering(list[ProposalRow], REFUSED))
    async def proposals(request: Request) -> JSONResponse:
        """The proposals of assistants, the last first."""
        return PlainJson(await run_in_threadpool(_desk(side).listed))

    @api.get("/proposals/base", **answering(ProposalBase, REFUSED))
    async def base(request: Request) -> JSONResponse:
        """Targets, kinds of devices and trees at work, on which a proposal can build."""
        return PlainJson(await run_in_threadpool(_desk(side).base))

    @api.get("/proposals/{hash}", **answering(WholeProposal, REFUSED))
    async def proposal(request: Request, hash: Hash) -> JSONResponse:
        """One proposal: its trees, what was proved and simulated of it, and what was decided."""
        return PlainJson(await run_in_threadpool(_desk(side).shown, hash))


def _propose(api: APIRouter, side: PlantApi) -> None:
    @api.post("/proposals", **answering(ProposalAnswer, REFUSED, described_body(NewProposal)))
    async def propose(request: Request) -> JSONResponse:
        """Check content and keep it for a person to decide on; nothing of it is at work by that."""
        desk, wanted = _desk(side), read_body(await request.body(), NewProposal)
        values = [(each.place, each.value) for each in wanted.values]
        return PlainJson(await run_in_threadpool(desk.propose, {**wanted.model_dump(), "values": values}))

    @api.post("/proposals/{hash}/prove", **answering(RunState, REFUSED, described_body(ProofRequest)))
    async def prove(request: Request, hash: Hash) -> JSONResponse:
        """Begin to try every single fault at every kind of moment of it, in a process beside the plant."""
        desk, wanted = _desk(side), read_body(await request.body(), ProofRequest)
        return PlainJson(await run_in_threadpool(desk.prove, hash, wanted.recipes, wanted.budget_s))

    @api.post("/proposals/{hash}/simulate", **answering(RunState, REFUSED, described_body(SimulationRequest)))
    async def simulate(request: Request, hash: Hash) -> JSONResponse:
        """Begin to run it on virtual devices with faults, in a process beside the plant."""
        desk, wanted = _desk(side), read_body(await request.body(), SimulationRequest)
        return PlainJson(await run_in_threadpool(desk.simulate, hash, wanted.seeds, wanted.cycles))

    @api.post("/proposals/{hash}/withdraw", **answering(ProposalRow, REFUSED))
    async def withdraw(request: Request, hash: Hash) -> JSONResponse:
        """Take a proposal back that nobody has decided on."""
        return PlainJson(await run_in_threadpool(_desk(side).withdraw, hash))

    @api.post(
        "/assistants/tasks",
        status_code=202,
        dependencies=GIVE,
        **answering(Task, REFUSED, described_body(AssistantTask)),
    )
    async def give(request: Request) -> JSONResponse:
        """Queue a task of a recipe that is approved as it is at work, within the limits of the plant file."""
        desk, wanted = _desk(side), read_body(await request.body(), AssistantTask)
        task = await run_in_threadpool(desk.submit, wanted.text, wanted.by)
        return PlainJson(explained(task), status_code=422 if task["state"] == "refused" else 202)


def _decide(api: APIRouter, side: PlantApi) -> None:
    @api.post(
        "/proposals/{hash}/approve",
        dependencies=DECIDE,
        **answering(DecidedProposal, REFUSED, described_body(Approval)),
    )
    async def approve(request: Request, hash: Hash) -> JSONResponse:
        """Approve the content with this hash, and put it to work: a cell takes it once its task has ended."""
        desk, wanted = _desk(side), read_body(await request.body(), Approval)
        return PlainJson(await run_in_threadpool(desk.approve, hash, wanted.name))

    @api.post(
        "/proposals/{hash}/reject",
        dependencies=DECIDE,
        **answering(ProposalRow, REFUSED, described_body(Rejection)),
    )
    async def reject(request: Request, hash: Hash) -> JSONResponse:
        """Reject a proposal, for a reason that its assistant reads."""
        desk, wanted = _desk(side), read_body(await request.body(), Rejection)
        return PlainJson(await run_in_threadpool(desk.reject, hash, wanted.name, wanted.reason))


def _desk(side: PlantApi) -> ProposalsApi:
    """The plant's proposals; 404 if it has none."""
    desk = side.ask(ProposalsApi)
    if desk is None:
        raise HTTPException(404, SHIPPED)
    return desk
