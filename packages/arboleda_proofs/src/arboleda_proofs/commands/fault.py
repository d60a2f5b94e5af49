"""`arboleda fault`: have something go wrong with a virtual device of the plant that runs."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import Annotated, Any

import typer

from arboleda.drivers import plain
from arboleda.extension import Phrase, RunningPlant, StateFolder, StoreAddress, TokensFile, client, say

LONGEST = 500  # characters of a line
SPAN = re.compile(r"(\d+(?:\.\d+)?)\s*(s|m|min)?")
SECONDS = {"s": 1.0, "m": 60.0, "min": 60.0}
END = "end"
FAULTS = "/api/faults"

NO_TIME = Phrase("cli.fault.no_time", "{value} is no time: write it as 5s, 0.5s or 2m")
LASTS_AT_BEGIN = Phrase("cli.fault.lasts_at_begin", "--for is of a fault that begins")
WHICH_DEVICE = Phrase("cli.fault.which_device", "which device? As in: arboleda fault {kind} ra1")
NONE_VIRTUAL = Phrase("cli.fault.none_virtual", "no device of this start is virtual: nothing can be provoked")
NONE_ON = Phrase("cli.fault.none_on", "no fault goes on")
NAMED = Phrase("cli.fault.named", "{robot}: {kind} ({about})")
ENDED = Phrase("cli.fault.ended", "{named}: ended")
BEGUN = Phrase("cli.fault.begun", "{named}, for {seconds} s")
GOES_ON = Phrase("cli.fault.goes_on", "{named}, for {seconds} s more")
AN_INSTANT = Phrase("cli.fault.an_instant", "{about} (an instant)")


def _seconds(value: str | None) -> float | None:
    if value is None:
        return None
    found = SPAN.fullmatch(value.strip())
    if found is None:
        raise typer.BadParameter(say(NO_TIME(value=repr(value))))
    return float(found[1]) * SECONDS[found[2] or "s"]


def add_to(cli: typer.Typer) -> None:
    """Add the command."""
    cli.command()(fault)


def fault(
    kind: Annotated[
        str | None,
        typer.Argument(metavar="KIND", help=f"What goes wrong, as --list names it, or {END}."),
    ] = None,
    device: Annotated[
        str | None, typer.Argument(metavar="DEVICE", help=f"A virtual device, e.g. ra1; {END}: all.")
    ] = None,
    seconds: Annotated[
        str | None,
        typer.Option("--for", metavar="TIME", help="For how long, as 5s or 2m. [default: 5s]"),
    ] = None,
    listed: Annotated[
        bool, typer.Option("--list", help="List what can go wrong with each virtual device.")
    ] = False,
    plant: RunningPlant = None,
    state: StateFolder = None,
    store: StoreAddress = "",
    tokens: TokensFile = None,
) -> None:
    """Have something go wrong with a virtual device: cut its link, reboot its board, lose its part.

    It ends by itself; `arboleda fault end ra1` ends it before. Without arguments: says which faults go
    on. After a restart of the plant there are none. Real devices are refused.

    Exit status: 0 begun or ended, 2 refused.
    """
    lasting_s = _seconds(seconds)
    reached = client(plant, state, store, tokens)
    if kind is None or listed:
        known = reached.get(FAULTS)
        _print(_offered(known["offers"]) if listed else _going_on(known["begun"]))
    elif kind == END:
        if lasting_s is not None:
            raise typer.BadParameter(say(LASTS_AT_BEGIN()))
        ended = reached.post(f"{FAULTS}/end", {"robot": device or ""}, is_repeatable=True)
        _print([say(ENDED(named=_named(each))) for each in ended] or [say(NONE_ON())])
    elif device is None:
        raise typer.BadParameter(say(WHICH_DEVICE(kind=plain(kind, 80))))
    else:
        lasting = {} if lasting_s is None else {"seconds": lasting_s}
        begun = reached.post(FAULTS, {"kind": kind, "robot": device, **lasting})
        left = f"{begun['left_s']:g}" if begun["left_s"] else ""
        _print([say(BEGUN(named=_named(begun), seconds=left)) if left else _named(begun)])


def _offered(offers: Iterable[dict[str, Any]]) -> list[str]:
    """A line for each kind: its name, what it is, and at which devices it can be provoked."""
    robots: dict[tuple[str, str], list[str]] = {}
    for each in offers:
        about = _about(each) if each["lasts"] else say(AN_INSTANT(about=_about(each)))
        robots.setdefault((each["kind"], about), []).append(each["robot"])
    lines = [f"{kind:<16} {about}: {', '.join(names)}" for (kind, about), names in robots.items()]
    return lines or [say(NONE_VIRTUAL())]


def _going_on(begun: Iterable[dict[str, Any]]) -> list[str]:
    lines = [say(GOES_ON(named=_named(each), seconds=f"{each['left_s']:.1f}")) for each in begun]
    return lines or [say(NONE_ON())]


def _named(each: dict[str, Any]) -> str:
    return say(NAMED(robot=each["robot"], kind=each["kind"], about=_about(each)))


def _about(each: dict[str, Any]) -> str:
    """A fault in the language of this terminal; as the plant says it, where that is another version."""
    from arboleda_proofs.simulator.mishaps import (
        MISHAPS,  # a whole simulator, which other commands need not load
    )

    mishap = MISHAPS.get(each["kind"])
    return str(each["about"]) if mishap is None else say(mishap.sentence)


def _print(lines: Iterable[str]) -> None:
    for line in lines:
        print(plain(line, LONGEST), flush=True)
