"""The operators' verbs as commands, `arboleda stop` to `arboleda answer`, made of their rows and words."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from inspect import Parameter, Signature
from typing import Any

import typer

from arboleda.client.errors import Conflict
from arboleda.model.errors import ArboledaError, TextError
from arboleda.model.messages import Outcome
from arboleda.model.outside import plain
from arboleda.model.sentence import Phrase, Sentence
from arboleda.model.verbs import Argument, Arguments, Scope, Verb, as_text, from_text
from arboleda.views.verb_words import ABOUT, VerbWords, scope_words

from .client import LONGEST, PlantClient
from .commands import BY_OPTION
from .language import question, say
from .plant_options import RunningPlant, StateFolder, StoreAddress, TokensFile, client
from .working import working

STATUS = "Exit status: 0 done, 1 no plant, 2 refused, 3 failed, 4 still under way."
FAILED, UNENDED = 3, 4
DID = {
    Outcome.SENT: Phrase("cli.did.sent", "sent: {did}"),
    Outcome.UNDER_WAY: Phrase("cli.did.under_way", "still under way: {did}"),
    Outcome.DONE: Phrase("cli.did.done", "done: {did}"),
    Outcome.UNCHECKED: Phrase("cli.did.unchecked", "sent, not checked: {did}"),
    Outcome.FAILED: Phrase("cli.did.failed", "failed: {did}"),
}
BECAUSE = Phrase("cli.did.because", "{did}: {why}")
OF_WHAT = Phrase("cli.did.of", "{verb}, {of}")
BY_HAND = Phrase("cli.did.by_hand", "{verb} by hand")
WHOLE_PLANT = Phrase("cli.did.whole_plant", "the whole plant")
NO_NAME = Phrase("cli.did.no_name", "the name is empty")
MISSING = Phrase("cli.did.missing", "it is missing")
UNCONFIRMED = Phrase("cli.did.unconfirmed", "The stop was not confirmed, use the hard-wired button: {error}")
BEHIND = "behind"  # the parameter of what stands behind the scope
OTHERWISE = "otherwise"  # the parameter of the option that stands for another verb
OPTIONS = {Verb.LOAD: "--out", Verb.TEACH: "--end"}
STATUSES = {Outcome.FAILED: FAILED, Outcome.UNDER_WAY: UNENDED}


def add_to(cli: typer.Typer) -> None:
    """Add a command per verb; some verbs are an option of another one."""
    for verb, words in ABOUT.items():
        if verb not in BY_OPTION.values():
            cli.command(verb.value, help=about(verb), short_help=words.brief)(_command(verb))


def about(verb: Verb) -> str:
    """The `--help` of a verb, with that of the verb that is its option."""
    parts = [_does(verb)]
    if verb in BY_OPTION:
        parts += [f"With {OPTIONS[verb]}:", _does(BY_OPTION[verb])]
    return "\n\n".join([*parts, STATUS])


def _does(verb: Verb) -> str:
    words = ABOUT[verb]
    does = words.does.replace("**", "")
    return f"{does[:1].upper()}{does[1:]}.\n\nRefused: {words.refused}."


def _command(verb: Verb) -> Callable[..., None]:
    """The command of a verb: typer reads its parameters from its signature."""

    def act(**options: Any) -> None:
        asked = BY_OPTION[verb] if options.get(OTHERWISE) else verb
        scope, sure = options["scope"], ABOUT[asked].sure
        _refuse_missing(asked, options)
        if sure and not options["yes"]:
            typer.confirm(question(asked.value, scope) or sure.format(scope=scope), abort=True)
        reached = client(*(options[each.name] for each in PLANT_OPTIONS))
        arguments = tuple(_values(asked, options))
        _ask(asked, scope, reached, by_hand=options.get("by_hand", False), arguments=arguments)

    parameters = [*_parameters(verb), *PLANT_OPTIONS]
    act.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
    act.__annotations__ = {each.name: each.annotation for each in parameters}
    return act


PLANT_OPTIONS = (
    Parameter("plant", Parameter.KEYWORD_ONLY, default=None, annotation=RunningPlant),
    Parameter("state", Parameter.KEYWORD_ONLY, default=None, annotation=StateFolder),
    Parameter("store", Parameter.KEYWORD_ONLY, default="", annotation=StoreAddress),
    Parameter("tokens", Parameter.KEYWORD_ONLY, default=None, annotation=TokensFile),
)


def _parameters(verb: Verb) -> Iterator[Parameter]:
    """The scope, the arguments and the options of a verb."""
    words, other = ABOUT[verb], BY_OPTION.get(verb)
    yield _parameter("scope", str | None, _scope(verb))
    behind = [each for each in verb.arguments if not each.mark]
    if behind:
        yield _behind(behind, words, needed=other is None and any(each.needed for each in behind))
    for each in (each for each in verb.arguments if each.mark):
        help = words.arguments[each.name]
        yield _parameter(each.name, str | None, typer.Option(None, f"--{each.name}", metavar="ID", help=help))
    if words.by_hand is not None:
        yield _parameter("by_hand", bool, typer.Option(False, "--by-hand", help=words.by_hand.option))
    if other is not None:
        option = typer.Option(False, OPTIONS[verb], help=ABOUT[other].brief)
        yield _parameter(OTHERWISE, bool, option)
    if words.sure:
        yield _parameter("yes", bool, typer.Option(False, "--yes", help="Do not ask."))


def _parameter(name: str, annotation: Any, default: Any) -> Parameter:
    return Parameter(name, Parameter.KEYWORD_ONLY, default=default, annotation=annotation)


def _behind(arguments: list[Argument], words: VerbWords, *, needed: bool) -> Parameter:
    """Words behind the scope: the arguments in their order."""
    metavar = " ".join(each.name.upper() for each in arguments)
    help = " ".join(words.arguments[each.name] for each in arguments)
    argument = typer.Argument(... if needed else None, metavar=metavar, help=help, show_default=False)
    return _parameter(BEHIND, list[str], argument)


def _refuse_missing(verb: Verb, options: dict[str, Any]) -> None:
    """Raise BadParameter for a missing argument, where an option says whether it is needed."""
    scope, missing = options["scope"], []
    if scope is None and Scope.PLANT not in verb.row.scopes:
        missing = [_metavar(verb)]
    elif verb.needs_arguments and not options.get(BEHIND) and " " not in (scope or ""):
        missing = [each.name.upper() for each in verb.arguments if each.needed]
    if missing:
        raise typer.BadParameter(say(MISSING()), param_hint=f"'{missing[0]}'")


def _values(verb: Verb, options: dict[str, Any]) -> Iterator[tuple[str, int | str]]:
    """The arguments of a verb as they were given."""
    for each in verb.arguments:
        if each.mark and options[each.name] is not None:
            yield each.name, options[each.name].removeprefix(each.mark)
    if options.get(BEHIND):
        yield from from_text(verb, " ".join([options["scope"] or "", *options[BEHIND]]))[1]


def _scope(verb: Verb) -> Any:
    everywhere = Scope.PLANT in verb.row.scopes
    words = scope_words(verb)[1:] if everywhere else scope_words(verb)
    needed = not everywhere and verb not in BY_OPTION
    note = " [default: the whole plant]" if everywhere else ""
    help = f"{' or '.join(words).capitalize()}.{note}"
    default = ... if needed else None
    return typer.Argument(default, metavar=_metavar(verb), help=help, callback=_named, show_default=False)


def _metavar(verb: Verb) -> str:
    words = scope_words(verb)
    one = len(words) == 1 and Scope.PLANT not in verb.row.scopes
    return words[0].split()[-1].upper() if one else "SCOPE"


def _named(scope: str | None) -> str | None:
    if scope is not None and not scope.strip():
        raise typer.BadParameter(say(NO_NAME()))  # an unset variable must not mean the whole plant
    return scope


def _ask(
    verb: Verb,
    scope: str | None,
    reached: PlantClient,
    *,
    by_hand: bool = False,
    arguments: Arguments = (),
) -> None:
    of, given = (scope or "", arguments) if arguments else from_text(verb, scope or "")
    try:
        with working():
            answer = reached.operate(verb, of, by_hand=by_hand, arguments=given)
            if answer.get("outcome") == Outcome.UNDER_WAY.value:
                answer = reached.outcome(answer["act"])
    except ArboledaError as error:
        if not verb.row.stops or isinstance(error, Conflict | TextError):
            raise
        raise ArboledaError(UNCONFIRMED(error=error.sentence)) from error
    called = ABOUT[verb].called or verb.value
    named = plain(as_text(verb, of, given)) or WHOLE_PLANT()
    _tell(answer, OF_WHAT(verb=BY_HAND(verb=called) if by_hand else called, of=named))


def _tell(answer: dict[str, Any], did: Sentence) -> None:
    """Print the outcome of an act, and exit with its status."""
    outcome = Outcome(answer.get("outcome") or Outcome.DONE.value)
    sentence = DID[outcome](did=did)
    print(say(BECAUSE(did=sentence, why=plain(answer["why"], LONGEST)) if answer.get("why") else sentence))
    if outcome in STATUSES:
        raise typer.Exit(STATUSES[outcome])
