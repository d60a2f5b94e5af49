"""The command `arboleda submit`: a task for the plant that runs."""

from __future__ import annotations

from typing import Annotated, Any

import typer

from arboleda.model.errors import ArboledaError
from arboleda.model.messages import TaskState
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase

from .complaint import FAILED, LONGEST, complain
from .language import say_row, word
from .plant_options import RunningPlant, StateFolder, StoreAddress, TokensFile, client
from .working import working

UNDONE = {TaskState.FAILED.value, TaskState.CANCELLED.value}
TASK_OVER = Phrase("cli.task_over", "the task #{id} is over; give another id to do it once more")


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(submit)


def submit(
    words: Annotated[
        list[str],
        typer.Argument(
            metavar="TASK",
            help="The task, e.g. 'sis_a 0B 7' or 'sis_a 0B 7 #lot42'; the id needs quotes.",
        ),
    ],
    wait: Annotated[
        bool, typer.Option("--wait", help="Print what becomes of it until it has ended.")
    ] = False,
    plant: RunningPlant = None,
    state: StateFolder = None,
    store: StoreAddress = "",
    tokens: TokensFile = None,
) -> None:
    """Send a task to the plant that runs on this machine, or that another host leads.

    Exit status: 0 accepted, with --wait done; 1 a task of that id has failed or was cancelled before, with
    --wait also this one; 2 refused. Ctrl-C ends the waiting and not the task. Where another host takes the
    plant over meanwhile, --wait goes on there.
    """
    with working():
        reached = client(plant, state, store, tokens)
        answer = reached.submit(" ".join(words))
    _print_task(answer)
    if answer["state"] in UNDONE:
        complain(ArboledaError(TASK_OVER(id=answer["id"])))
        raise typer.Exit(FAILED)
    if not wait:
        return
    last = answer
    for last in reached.follow(answer):
        _print_task(last)
    if last["state"] in UNDONE:
        raise typer.Exit(FAILED)


def _print_task(row: dict[str, Any]) -> None:
    choice = row.get("choice") if row["state"] == TaskState.QUEUED.value else ""
    remarks = "; ".join(each for each in (choice, say_row(row)) if each)
    line = f"{word('task_state', row['state'])}: {row['text']} (id {row['id']})" + (
        f"  {remarks}" if remarks else ""
    )
    print(plain(line, LONGEST), flush=True)
