"""A mosquitto with the folder that `arboleda certs --mosquitto` makes: who is let in, and who may do what."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from typer.testing import CliRunner

from arboleda.adapters.broker_login import address
from arboleda.cli.main import cli
from arboleda.wire.transport import Publication

from .conftest import Authority, said

pytestmark = [pytest.mark.requires("cryptography"), pytest.mark.requires("mosquitto")]
BY_THE_FIXTURE = ("#", "listener", "set_tcp_nodelay")


@pytest.fixture
def lab_of(tmp_path: Path) -> Path:
    """The folder, for a mosquitto on this machine."""
    words = ["certs", str(tmp_path / "lab"), "--mosquitto", "127.0.0.1"]
    assert CliRunner().invoke(cli, [*words, "--at", str(tmp_path / "lab/mosquitto")]).exit_code == 0
    return tmp_path / "lab"


@pytest.fixture
def broker(mosquitto: Callable[..., Any], lab_of: Path) -> Any:
    lines = (lab_of / "mosquitto/mosquitto.conf").read_text().splitlines()
    started = mosquitto(
        "user root", *(line for line in lines if line and not line.startswith(BY_THE_FIXTURE))
    )
    started.start()
    return started


@pytest.fixture
def client(
    broker: Any, lab_of: Path, trusts: Callable[..., None], peer: Callable[..., Any]
) -> Callable[..., Any]:
    """A client with the certificate of that name, which hears some topics."""

    def connect(user: str, *topics: str, folder: Path = lab_of) -> Any:
        pair = folder / ("plant" if user == "plant" else f"boards/{user}")
        trusts(lab_of / "ca.crt", pair.with_suffix(".crt"), pair.with_suffix(".key"))
        return peer(user, address(f"mqtts://127.0.0.1:{broker.address.port}"), subscriptions=topics)

    return connect


def heard(listener: Any) -> list[str]:
    return [delivery.topic for delivery in listener.inbox.deliveries]


def test_plant_and_board_reach_each_other_and_no_board_commands_or_speaks_for_another(
    client: Callable[..., Any],
) -> None:
    plant, other = client("plant", "#").up(), client("ra_2", "ra_1/sensores", "ra_2/juntas").up()
    for topic in ("ra_1/juntas", "ra_1/sensores", "ra_2/juntas", "ra_2/conexion"):
        other.client.publish(Publication(topic=topic, payload=b"1"))
    plant.inbox.wait(lambda inbox: inbox.deliveries)
    plant.client.publish(Publication(topic="ra_1/sensores", payload=b"secret"))
    plant.client.publish(Publication(topic="ra_2/juntas", payload=b"goal"))
    other.inbox.wait(lambda inbox: inbox.deliveries)
    assert heard(plant)[0] == "ra_2/conexion" and heard(other) == ["ra_2/juntas"]


@pytest.mark.requires("openssl")
def test_a_board_of_another_authority_is_not_let_in(
    client: Callable[..., Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    stranger = Authority(tmp_path / "boards")
    stranger.sign("ra_1")
    refused = client("ra_1", folder=tmp_path)
    said(caplog, "The MQTT broker at")
    assert refused.inbox.links == []
