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
    """Certificate of a server, as PEM, with the TLS context that serves it.

    `until` is its end in Unix seconds; with `asks` clients are asked for a certificate, too.
    """

    certificate: Path
    context: ssl.SSLContext = field(repr=False, compare=False)
    pem: str = field(repr=False)
    until: float
    asks: bool = False

    def note(self, now: float) -> str | None:
        """A sentence on a certificate that has expired or soon will; else None. `now`: Unix s."""
        if self.until - now > SOON_S:
            return None
        day = datetime.fromtimestamp(self.until, timezone.utc).strftime("%Y-%m-%d")
        how = f"has expired on {day}: nobody believes it" if self.until <= now else f"expires on {day}"
        return f"The certificate {self.certificate} {how}; make a new one, e.g. with mkcert"


def server_tls(certificate: Path, key: Path | None = None, *, authority: Path | None = None) -> ServerTls:
    """The certificate and TLS context for a server; raises StartError, which names the file that is of no
    use.

    With `authority` clients are asked for a certificate that this authority signed.
    """
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
        # Optional, so that a client without one is refused over MQTT, with words in the log.
        context.verify_mode = ssl.CERT_OPTIONAL
    return ServerTls(
        certificate=certificate, context=context, pem=pem, until=until, asks=authority is not None
    )


def pinned(pem: str) -> ssl.SSLContext:
    """TLS settings for a client on the same machine, which trusts this one certificate and no other.

    It does so whatever the server's name, whoever signed it, and however old it is.
    """
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    context.check_hostname = False
    context.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN | NO_CHECK_TIME
    context.load_verify_locations(cadata=pem)
    return context


def _shown(context: ssl.SSLContext) -> str:
    """The certificate that a server with this context shows, as PEM."""
    curious = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    curious.check_hostname, curious.verify_mode = False, ssl.CERT_NONE
    return ssl.DER_cert_to_PEM_cert(_met(context, curious).getpeercert(True) or b"")


def _read(context: ssl.SSLContext, pem: str) -> dict[str, object]:
    """The fields of the certificate, as Python's ssl reads them."""
    return dict(_met(context, pinned(pem)).getpeercert() or {})


def _met(server: ssl.SSLContext, client: ssl.SSLContext) -> ssl.SSLObject:
    """The client's end of a TLS handshake made in memory."""
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
    """Raises ValueError for an encrypted key; without it OpenSSL would ask for a password in the terminal."""
    raise ValueError("the key is encrypted; write it without password, readable for its owner only")


@contextmanager
def _explained(what: str) -> Iterator[None]:
    try:
        yield
    except (OSError, ValueError) as error:
        raise StartError(f"{what} ({getattr(error, 'strerror', None) or error})") from error
