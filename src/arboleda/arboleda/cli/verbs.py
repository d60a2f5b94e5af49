"""The operator's verbs as commands, `arboleda stop` to `arboleda override`: one table, three shapes."""

from __future__ import annotations

from collections.abc import Callable
from typing import Annotated, Any

import typer

from arboleda.model.errors import ArboledaError, TextError
from arboleda.model.messages import Outcome, Verb
from arboleda.model.outside import plain
from arboleda.views.verb_words import ABOUT, PLANT, VerbWords

from .client import LONGEST, PlantClient
from .line import VerbRefused
from .plant_options import PlantFile, StateFolder, StoreAddress, TokensFile, client

STATUS = "Exit status: 0 done, 1 no plant, 2 refused, 3 failed, 4 still under way."
FAILED, UNENDED = 3, 4
HomedByHand = Annotated[
    bool,
    typer.Option("--by-hand", help="Move nothing: you declare that the robot stands at its reference."),
]
TakenOut = Annotated[
    bool,
    typer.Option("--by-hand", help="Open nothing: you declare that you have taken the part out."),
]
Question = Annotated[
    str | None,
    typer.Option("--question", metavar="ID", help="Only if this is still what is asked, by its id."),
]
Yes = Annotated[bool, typer.Option("--yes", help="Do not ask.")]


WORDS = {Outcome.UNDER_WAY: "still under way", Outcome.UNCHECKED: "sent, not checked"}
STATUSES = {Outcome.FAILED: FAILED, Outcome.UNDER_WAY: UNENDED}
LABELS = {Verb.STOP: "stop (software)"}


def add_to(cli: typer.Typer) -> None:
    """Add a command per verb."""
    makers = {Verb.HOME: _home, Verb.RELEASE: _release, Verb.OVERRIDE: _override, Verb.ANSWER: _answer}
    for verb, words in ABOUT.items():
        act = makers.get(verb, _plain)(verb, _argument(words.scopes))
        cli.command(verb.value, help=about(words), short_help=words.brief)(act)


def about(words: VerbWords) -> str:
    """The `--help` of a verb."""
    does = words.does.replace("**", "")
    return f"{does[:1].upper()}{does[1:]}.\n\nRefused: {words.refused}.\n\n{STATUS}"


def _argument(scopes: tuple[str, ...]) -> Any:
    *others, last = [each for each in scopes if each != PLANT]
    default, note = (None, " [default: the whole plant]") if PLANT in scopes else (..., "")
    help, metavar = f"A {' or '.join([*others, last])}.{note}", "SCOPE" if others or note else last.upper()
    return typer.Argument(default, metavar=metavar, help=help, callback=_named, show_default=False)


def _named(scope: str | None) -> str | None:
    if scope is not None and not scope.strip():
        raise typer.BadParameter("the name is empty")  # an unset variable must not mean the whole plant
    return scope


def _plain(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        scope: str | None = argument,
        plant: PlantFile = None,
        state: StateFolder = None,
        store: StoreAddress = "",
        tokens: TokensFile = None,
    ) -> None:
        _ask(verb, scope, client(plant, state, store, tokens))

    return act


def _home(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        scope: str | None = argument,
        by_hand: HomedByHand = False,
        plant: PlantFile = None,
        state: StateFolder = None,
        store: StoreAddress = "",
        tokens: TokensFile = None,
    ) -> None:
        _ask(verb, scope, client(plant, state, store, tokens), by_hand=by_hand)

    return act


def _release(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        scope: str | None = argument,
        by_hand: TakenOut = False,
        plant: PlantFile = None,
        state: StateFolder = None,
        store: StoreAddress = "",
        tokens: TokensFile = None,
    ) -> None:
        _ask(verb, scope, client(plant, state, store, tokens), by_hand=by_hand)

    return act


def _override(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        scope: str | None = argument,
        yes: Yes = False,
        plant: PlantFile = None,
        state: StateFolder = None,
        store: StoreAddress = "",
        tokens: TokensFile = None,
    ) -> None:
        question = f"A robot may still stand in {scope}. Have you seen that it is free?"
        if not yes:
            typer.confirm(question, abort=True)
        _ask(verb, scope, client(plant, state, store, tokens))

    return act


def _answer(verb: Verb, argument: Any) -> Callable[..., None]:
    def act(
        person: Annotated[str, typer.Argument(help="Who is asked.", callback=_named)],
        answer: Annotated[list[str], typer.Argument(help="One of the answers that are offered.")],
        question: Question = None,
        plant: PlantFile = None,
        state: StateFolder = None,
        store: StoreAddress = "",
        tokens: TokensFile = None,
    ) -> None:
        named = [] if question is None else [f"#{question.removeprefix('#')}"]
        _ask(verb, " ".join([person, *named, *answer]), client(plant, state, store, tokens))

    return act


def _ask(verb: Verb, scope: str | None, reached: PlantClient, *, by_hand: bool = False) -> None:
    try:
        answer = reached.operate(verb, scope or "", by_hand=by_hand)
        if answer.get("outcome") == Outcome.UNDER_WAY.value:
            answer = reached.outcome(answer["act"])
    except ArboledaError as error:
        if verb is not Verb.STOP or isinstance(error, VerbRefused | TextError):
            raise
        raise ArboledaError(f"The stop was not confirmed, use the hard-wired button: {error}") from error
    did = LABELS.get(verb, verb.value) + (" by hand" if by_hand else "")
    _tell(answer, f"{did}, {plain(scope or 'the whole plant')}")


def _tell(answer: dict[str, Any], did: str) -> None:
    """Print the outcome of an act, and exit with its status."""
    outcome = Outcome(answer.get("outcome") or Outcome.DONE.value)
    why = f": {plain(answer['why'], LONGEST)}" if answer.get("why") else ""
    print(f"{WORDS.get(outcome, outcome.value)}: {did}{why}")
    if outcome in STATUSES:
        raise typer.Exit(STATUSES[outcome])
