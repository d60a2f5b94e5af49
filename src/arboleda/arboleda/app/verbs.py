"""The operator's verbs as commands, `arboleda stop` to `arboleda override`: one table, three shapes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from arboleda.core.messages import Verb
from arboleda.core.outside import plain

from .where import PlantFile, StateFolder, client

STATUS = "Exit status: 0 done, 1 no plant, 2 refused."
ByHand = Annotated[
    bool,
    typer.Option("--by-hand", help="Move nothing: you declare that the robot stands at its reference."),
]
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask.")]


@dataclass(frozen=True, kw_only=True)
class Words:
    """What a screen says of a verb; `needed` where it is not for the whole plant."""

    help: str
    scope: str
    label: str | None = None
    metavar: str = "SCOPE"
    needed: bool = False


WORDS = {
    Verb.STOP: Words(
        label="stop (software)",
        help="Stop (software): halt and latch every robot; running tasks fail, effectors keep their state. "
        "No safety function.",
        scope="cell or robot",
    ),
    Verb.CLEAR: Words(
        help="Take the stop latch off once every online robot is still; moves nothing.", scope="cell or robot"
    ),
    Verb.RESET: Words(help="After clear, make the cell ready again; moves nothing.", scope="cell"),
    Verb.HOLD: Words(help="Halt at once; task, part and zones are kept for resume.", scope="cell"),
    Verb.RESUME: Words(help="Go on at the step that was held, or with a queue that pauses.", scope="cell"),
    Verb.CANCEL: Words(
        help="End a task as cancelled, a running one once its robots have stopped.",
        scope="cell or task id",
        needed=True,
    ),
    Verb.RETRY: Words(
        help="After a fault, do the failed step again with a new command.", scope="cell", needed=True
    ),
    Verb.ABANDON: Words(
        help="After a fault, end the task as failed and recover: bring the part back, go home.",
        scope="cell",
        needed=True,
    ),
    Verb.RELEASE: Words(
        help="Open the effector where it is; a part that it holds falls.", scope="cell or arm", needed=True
    ),
    Verb.HOME: Words(help="Run a robot's homing routine.", scope="cell or robot", needed=True),
    Verb.OVERRIDE: Words(
        help="Free a quarantined zone, where a robot may still stand; this is journalled.",
        scope="zone",
        metavar="ZONE",
        needed=True,
    ),
}


def add_to(cli: typer.Typer) -> None:
    """Add a command per verb."""
    shapes = {Verb.HOME: _home, Verb.OVERRIDE: _override}
    for verb, words in WORDS.items():
        act = shapes.get(verb, _plain)(verb, _argument(words))
        cli.command(verb.value, help=f"{words.help} {STATUS}", short_help=words.help)(act)


def _argument(words: Words) -> Any:
    default = ... if words.needed else None
    scope = f"A {words.scope}." + ("" if words.needed else " [default: the whole plant]")
    return typer.Argument(default, metavar=words.metavar, help=scope, callback=_named, show_default=False)


def _named(scope: str | None) -> str | None:
    if scope is not None and not scope.strip():
        raise typer.BadParameter("the name is empty")  # an unset variable must not mean the whole plant
    return scope


def _plain(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(scope: str | None = argument, plant: PlantFile = None, state: StateFolder = None) -> None:
        _ask(verb, scope, plant, state)

    return act


def _home(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        scope: str | None = argument,
        by_hand: ByHand = False,
        plant: PlantFile = None,
        state: StateFolder = None,
    ) -> None:
        _ask(verb, scope, plant, state, by_hand=by_hand)

    return act


def _override(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        scope: str | None = argument, yes: Yes = False, plant: PlantFile = None, state: StateFolder = None
    ) -> None:
        question = f"A robot may still stand in {scope}. Have you seen that it is free?"
        if not yes:
            typer.confirm(question, abort=True)
        _ask(verb, scope, plant, state)

    return act


def _ask(
    verb: Verb, scope: str | None, plant: Path | None, state: Path | None, *, by_hand: bool = False
) -> None:
    client(plant, state).operate(verb, scope or "", by_hand=by_hand)
    print(f"done: {WORDS[verb].label or verb.value}, {plain(scope or 'the whole plant')}")
