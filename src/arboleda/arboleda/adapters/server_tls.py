"""The certificate of a server of this process, and how who speaks to it from here believes it."""

from __future__ import annotations

import ssl
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import datetime, timezone
from pathlib import Path

from arboleda.model.errors import StartError

SOON_S = 30 * 86400.0
ROUNDS = 4  # of a handshake in memory; two are enough
NO_CHECK_TIME = ssl.VerifyFlags(0x200000)  # X509_V_FLAG_NO_CHECK_TIME of OpenSSL


@dataclass(frozen=True, kw_only=True)
class ServerTls:
    """What a server shows, as PEM, and until when it holds, in unix seconds; `asks` where clients are to show
    a certificate, too."""

    certificate: Path
    context: ssl.SSLContext = field(repr=False, compare=False)
    pem: str = field(repr=False)
    until: float
    asks: bool = False

    def note(self, now: float) -> str | None:
        """What a person should know of a certificate that has ended or soon will."""
        if self.until - now > SOON_S:
            return None
        day = datetime.fromtimestamp(self.until, timezone.utc).strftime("%Y-%m-%d")
        how = f"has expired on {day}: nobody believes it" if self.until <= now else f"expires on {day}"
        return f"The certificate {self.certificate} {how}; make a new one, e.g. by `arboleda certs`"


def server_tls(certificate: Path, key: Path | None = None, *, authority: Path | None = None) -> ServerTls:
    """What a server is to show; with `authority` it asks clients for a certificate of that. StartError names
    the file that is of no use."""
    context = ssl.create_default_context(ssl.Purpose.CLIENT_AUTH)
    context.options |= ssl.OP_NO_RENEGOTIATION  # a client could have the server compute for nothing
    of_no_use = f"{certificate} and its key {key or 'in it'} are of no use"
    with _explained(of_no_use):
        context.load_cert_chain(certificate, key, password=_none)
    pem = _shown(context)
    until = ssl.cert_time_to_seconds(str(_read(context, pem)["notAfter"]))
    if authority is not None:
        with _explained(f"{authority} holds no certificates of an authority"):
            context.load_verify_locations(authority)
        # Optional: who shows none is told no over MQTT, in words that its log has.
        context.verify_mode = ssl.CERT_OPTIONAL
    return ServerTls(
        certificate=certificate, context=context, pem=pem, until=until, asks=authority is not None
    )


def pinned(pem: str) -> ssl.SSLContext:
    """For a client on the same machine: it believes that one certificate and no other, whatever the server is
    called, whoever signed it and however old it is."""
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN | NO_CHECK_TIME
    context.load_verify_locations(cadata=pem)
    return context


def _shown(context: ssl.SSLContext) -> str:
    """The certificate that a server with this context shows."""
    curious = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    curious.check_hostname, curious.verify_mode = False, ssl.CERT_NONE
    return ssl.DER_cert_to_PEM_cert(_met(context, curious).getpeercert(True) or b"")


def _read(context: ssl.SSLContext, pem: str) -> dict[str, object]:
    """What the certificate says."""
    return dict(_met(context, pinned(pem)).getpeercert() or {})


def _met(server: ssl.SSLContext, client: ssl.SSLContext) -> ssl.SSLObject:
    """The client's end after a handshake in memory."""
    up, down = ssl.MemoryBIO(), ssl.MemoryBIO()
    ours, theirs = server.wrap_bio(up, down, server_side=True), client.wrap_bio(down, up)
    for _ in range(ROUNDS):
        for end in (theirs, ours):
            try:
                end.do_handshake()
            except ssl.SSLWantReadError:
                continue
    return theirs


def _none() -> str:
    """Else OpenSSL would ask the terminal."""
    raise ValueError("the key is encrypted; write it without password, readable for its owner only")


@contextmanager
def _explained(what: str) -> Iterator[None]:
    try:
        yield
    except (OSError, ValueError) as error:
        raise StartError(f"{what} ({getattr(error, 'strerror', None) or error})") from error
