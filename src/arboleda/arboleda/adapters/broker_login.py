"""Address of the MQTT broker and the login for it; loaded without any library of MQTT."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from arboleda.model.errors import StartError

if TYPE_CHECKING:
    import ssl  # slow to load, and needed for TLS only

MQTT_PORT = 1883
SECURE = "mqtts://"
TLS_PORT = 8883  # as registered for MQTT over TLS
CA, CERTIFICATE, KEY = "ARBOLEDA_MQTT_CA", "ARBOLEDA_MQTT_CERT", "ARBOLEDA_MQTT_KEY"  # files
USER, PASSWORD = "ARBOLEDA_MQTT_USER", "ARBOLEDA_MQTT_PASSWORD"  # anybody can read a command line


@dataclass(frozen=True, kw_only=True)
class Address:
    """Host and port of a broker; `tls` has the settings of clients that encrypt, None without TLS."""

    host: str
    port: int
    tls: ssl.SSLContext | None = field(default=None, repr=False, compare=False)

    def __str__(self) -> str:
        host = f"[{self.host}]" if ":" in self.host else self.host
        return f"{SECURE if self.tls else ''}{host}:{self.port}"


@dataclass(frozen=True, kw_only=True)
class Credentials:
    """User name and password of an MQTT client."""

    user: str
    password: str = field(repr=False)


def login() -> Credentials | None:
    """The credentials from the environment for logging in to a broker; None if no user is set."""
    user = os.environ.get(USER)
    return Credentials(user=user, password=os.environ.get(PASSWORD, "")) if user else None


def address(text: str) -> Address:
    """Parses HOST:PORT or HOST, with mqtts:// before it for TLS; raises StartError for anything else."""
    secure, plain = text.startswith(SECURE), text.removeprefix(SECURE).removeprefix("mqtt://")
    host, colon, port = plain.rpartition(":")
    if not colon:
        host, port = plain, str(TLS_PORT if secure else MQTT_PORT)
    if not host or "/" in host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise StartError(
            f"'{text}' is not a broker address; write HOST:PORT, e.g. 127.0.0.1:{MQTT_PORT}, or with TLS "
            f"{SECURE}HOST:PORT"
        )
    return Address(host=host.strip("[]"), port=int(port), tls=_tls() if secure else None)


def _tls() -> ssl.SSLContext:
    """The TLS settings of this process's MQTT clients: the authority they trust, and their own certificate.

    Raises StartError, which names the file that is of no use.
    """
    import ssl

    authority, certificate, key = (os.environ.get(name) or None for name in (CA, CERTIFICATE, KEY))
    try:
        context = ssl.create_default_context(cafile=authority)
    except OSError as error:
        raise StartError(f"${CA}: {authority} holds no certificates of an authority ({error})") from error
    if key is not None and certificate is None:
        raise StartError(f"${KEY} names a key without its certificate; name that in ${CERTIFICATE}")
    if certificate is not None:
        try:
            context.load_cert_chain(certificate, key)
        except OSError as error:
            raise StartError(f"${CERTIFICATE}: {certificate} and its key are of no use ({error})") from error
    return context
