"""A mosquitto with the files of docs/how-to/tls.md: who is let in, and who may do what."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from arboleda.adapters.broker_login import TLS_PORT, address
from arboleda.adapters.mqtt_broker.limits import PACKET_BYTES
from arboleda.wire.transport import Publication

from ..documents import boxes
from ..tls_lab import Lab
from .conftest import said

pytestmark = pytest.mark.requires("mosquitto")
BY_THE_FIXTURE = {"#", "listener", "set_tcp_nodelay"}
AT = "/etc/mosquitto/arboleda"


def of_page(name: str) -> str:
    """The file of that name that the page shows."""
    page = (Path(__file__).parents[2] / "docs/how-to/tls.md").read_text("utf-8")
    (text,) = [box for _, box in boxes(page) if box.startswith(f"# {name}\n")]
    return text


@pytest.fixture
def broker(mosquitto: Callable[..., Any], lab: Lab, tmp_path: Path) -> Any:
    text = of_page("mosquitto.conf")
    assert f"listener {TLS_PORT}\n" in text and f"max_packet_size {PACKET_BYTES}\n" in text
    (tmp_path / "acl").write_text(of_page("acl"))
    certificate, key = lab.sign("127.0.0.1")
    files = {"ca.crt": lab.certificate, "broker.crt": certificate, "broker.key": key, "acl": tmp_path / "acl"}
    for name, file in files.items():
        assert f"{AT}/{name}\n" in text
        text = text.replace(f"{AT}/{name}\n", f"{file}\n")
    lines = [line for line in text.splitlines() if line.split()[0] not in BY_THE_FIXTURE]
    started = mosquitto("user root", *lines)
    started.start()
    return started


@pytest.fixture
def client(
    broker: Any, lab: Lab, trusts: Callable[..., None], peer: Callable[..., Any]
) -> Callable[..., Any]:
    """A client with the certificate of that name, which hears some topics."""

    def connect(user: str, *topics: str, signed_by: Lab = lab) -> Any:
        trusts(lab.certificate, *signed_by.sign(user))
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


def test_a_board_of_another_authority_is_not_let_in(
    client: Callable[..., Any], tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    refused = client("ra_1", signed_by=Lab(tmp_path / "others"))
    said(caplog, "The MQTT broker at")
    assert refused.inbox.links == []
