"""The arguments of a launch, checked as a whole."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from arboleda.adapters.broker_login import MQTT_PORT, address
from arboleda.extension import StartError
from arboleda.runtime.rate import check_rate

from .arguments import AUTO, EMBEDDED

LAST_PORT = 65_535


@dataclass(frozen=True, kw_only=True)
class Choice:
    """The arguments as values; an empty text, or port 0, stands for the node's own default."""

    plant: str
    sim: bool
    broker: str
    orchestrator: bool
    dashboard: bool
    port: int
    rviz: bool
    describe: bool
    state_dir: str
    rate: float

    @property
    def names_broker(self) -> bool:
        """True where the broker is none that the launch brings."""
        return self.broker != EMBEDDED

    @property
    def broker_address(self) -> str:
        """The address at which the bridge reaches the broker, as HOST:PORT."""
        return self.broker if self.names_broker else f"127.0.0.1:{MQTT_PORT}"


def read(texts: Mapping[str, str]) -> Choice:
    """The choice of these launch arguments by name; StartError where they do not go together."""
    choice = Choice(
        plant=texts["plant"],
        sim=texts["sim"] == "true",
        broker=texts["broker"],
        orchestrator=texts["orchestrator"] == "true",
        dashboard=texts["dashboard"] == "true",
        port=_port(texts["port"]),
        rviz=texts["rviz"] == "true",
        describe=(texts["rviz"] if texts["describe"] == AUTO else texts["describe"]) == "true",
        state_dir=texts["state_dir"],
        rate=_rate(texts["rate"]),
    )
    _check_broker(choice)
    if choice.port and not (choice.orchestrator and choice.dashboard):
        raise StartError("port is for the page (dashboard:=true), which comes with the orchestrator")
    if choice.rate != 1 and not choice.sim:
        raise StartError("rate is for virtual boards (sim:=true); real ones have the speed they have")
    return choice


def _rate(text: str) -> float:
    try:
        return check_rate(float(text))
    except ValueError:
        raise StartError(f"'{text}' is not a rate; allowed: 0.1 to 100") from None


def _port(text: str) -> int:
    if text and not (text.isascii() and text.isdigit() and 1 <= int(text) <= LAST_PORT):
        raise StartError(f"'{text}' is not a port; allowed: 1 to {LAST_PORT}")
    return int(text or 0)


def _check_broker(choice: Choice) -> None:
    if choice.names_broker:
        address(choice.broker)
    elif not choice.sim:
        raise StartError(
            "broker:=embedded is for virtual boards (sim:=true); with sim:=false name the broker of "
            "the real ones: broker:=HOST:PORT"
        )
