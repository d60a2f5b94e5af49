"""Configuration of a mosquitto for a plant and its boards: TLS, logins by certificate, access rights."""

from __future__ import annotations

from pathlib import Path

from arboleda.adapters.broker_login import TLS_PORT
from arboleda.adapters.mqtt_broker.access import BOARDS_WRITE
from arboleda.adapters.mqtt_broker.limits import PACKET_BYTES
from arboleda.wire.topics import topic

CONFIGURATION, ACL = "mosquitto.conf", "acl"
USER = "%u"  # mosquitto replaces it by the user's name


def texts(at: Path, plant: str) -> dict[str, str]:
    """The files by name, for a mosquitto that has them in the folder `at`; the plant logs in as `plant`."""
    return {CONFIGURATION: _configuration(at), ACL: _acl(plant)}


def _configuration(at: Path) -> str:
    return f"""# Each client shows a certificate, and is the user whose name that has.
listener {TLS_PORT}
cafile {at}/ca.crt
certfile {at}/broker.crt
keyfile {at}/broker.key
require_certificate true
use_identity_as_username true
allow_anonymous false
acl_file {at}/{ACL}
set_tcp_nodelay true
max_packet_size {PACKET_BYTES}
"""


def _acl(plant: str) -> str:
    writes = "".join(f"pattern write {topic(USER, channel)}\n" for channel in BOARDS_WRITE)
    return f"""# The plant does everything; a board, whose user is its MQTT name, has its own topics.
user {plant}
topic readwrite #

{writes}pattern read {USER}/#
"""
