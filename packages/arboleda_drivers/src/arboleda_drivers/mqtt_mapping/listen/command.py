"""The command `arboleda topics listen`."""

from __future__ import annotations

import time
from queue import Empty, SimpleQueue
from typing import Annotated

import typer

from arboleda.adapters.broker_login import address, login
from arboleda.adapters.mqtt import MqttClient
from arboleda.cli.overview import WholeSentences
from arboleda.extension import Phrase, StartError, say
from arboleda.wire.transport import Connection, Delivery
from arboleda_drivers.mqtt_mapping.keys import BROKER

from .hearing import Listening
from .proposal import proposal

CONNECT_S = 5.0
NO_BROKER = Phrase("cli.topics.no_broker", "the MQTT broker at {broker} is not there")
NOTHING_SAID = Phrase(
    "cli.topics.nothing_said", "nothing was said on {topic} at {broker} for {seconds:.0f} s"
)


def add_to(parent: typer.Typer) -> None:
    """Add the group `topics`."""
    cli = typer.Typer(
        cls=WholeSentences,
        help="Find out by which MQTT topics a device speaks.",
        no_args_is_help=True,
        rich_markup_mode=None,
    )
    cli.callback()(_nothing)
    cli.command("listen")(listen)
    parent.add_typer(cli, name="topics")


def listen(
    about: Annotated[
        str, typer.Argument(metavar="TOPIC", help="Topics to listen to, with + and #, as tele/lamp/#.")
    ] = "#",
    broker: Annotated[str, typer.Option(metavar="HOST:PORT", help="The broker, mqtts:// for TLS.")] = BROKER,
    seconds: Annotated[float, typer.Option(min=1, max=3600, help="For how long.")] = 60.0,
) -> None:
    """Listen beside a device, and propose how to map what it says.

    Press its buttons meanwhile. Nothing is sent.
    """
    events: SimpleQueue[Delivery | Connection] = SimpleQueue()
    name = f"arboleda-listens-{time.time_ns() % 10**8}"
    client = MqttClient(
        name, address(broker), on_event=events.put, subscriptions=[about], credentials=login()
    )
    heard = Listening()
    client.start()
    try:
        took_s = _hear(events, heard, broker, seconds)
    finally:
        client.close()
    if not heard.places:
        raise StartError(say(NOTHING_SAID(topic=about, broker=broker, seconds=took_s)))
    named = "" if broker == BROKER else broker
    print("\n".join(["", *heard.rates(took_s), *proposal(heard, named)]))


def _hear(events: SimpleQueue[Delivery | Connection], heard: Listening, broker: str, seconds: float) -> float:
    """Take what is said for that long, or until Ctrl-C; a place is shown as it is heard first."""
    began = time.monotonic()
    is_up = False
    try:
        while (left := began + seconds - time.monotonic()) > 0:
            if not is_up and time.monotonic() > began + CONNECT_S:
                raise StartError(say(NO_BROKER(broker=broker)))
            try:
                event = events.get(timeout=min(left, 0.2))
            except Empty:
                continue
            if isinstance(event, Connection):
                is_up = is_up or event.up
                continue
            known = len(heard.places)
            heard.take(event.topic, event.payload, retained=event.retain, at=time.monotonic())
            for line in heard.lines(known):
                print(line, flush=True)
    except KeyboardInterrupt:
        print()
    if not is_up:
        raise StartError(say(NO_BROKER(broker=broker)))
    return time.monotonic() - began


def _nothing() -> None:
    """Make the group take commands."""
