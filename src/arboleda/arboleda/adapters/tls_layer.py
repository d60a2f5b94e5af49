"""TLS between a connection of asyncio and the protocol that it is for.

asyncio's own tells a protocol of its connection only after the handshake: until then nobody would count it,
and nobody would know why it failed.
"""

from __future__ import annotations

import asyncio
import logging
import ssl
from collections.abc import Callable
from contextlib import suppress
from typing import Any

from arboleda.model.outside import plain

from .rate_limit import RateLimit

LOG = logging.getLogger(__name__)
HANDSHAKE = 0x16  # the first byte of a TLS connection
READ_BYTES = 16 * 1024  # read at once: so much and one TLS record may wait for the end of a pause
DISTRUST = "does not believe this certificate"
REFUSALS = {  # by OpenSSL's reason: the cause of a failed handshake, and the advice
    "TLSV1_ALERT_UNKNOWN_CA": f"{DISTRUST}: give it the file of the authority",
    "SSLV3_ALERT_CERTIFICATE_EXPIRED": f"{DISTRUST}: it has expired; renew it, or set the clock there",
    "SSLV3_ALERT_BAD_CERTIFICATE": f"{DISTRUST}: it may lack the name by which this machine is called",
    "SSLV3_ALERT_CERTIFICATE_UNKNOWN": f"{DISTRUST}: it may lack its authority, or the name of this machine",
    "TLSV1_ALERT_PROTOCOL_VERSION": "speaks too old a TLS",
    "UNSUPPORTED_PROTOCOL": "speaks too old a TLS",
    "NO_SHARED_CIPHER": "has no cipher that this server takes",
}


class TlsLayer(asyncio.BufferedProtocol):
    """TLS between a connection of `server`, its name in the log, and the protocol `inner`.

    `inner` is told of the connection before the handshake, and may end it. A client that speaks no TLS gets
    `plain_answer`.
    """

    def __init__(
        self,
        context: ssl.SSLContext,
        inner: Any,
        *,
        server: str,
        seldom: RateLimit,
        plain_answer: bytes = b"",
    ) -> None:
        self.inner = inner
        self._in, self._out = ssl.MemoryBIO(), ssl.MemoryBIO()
        self._read = bytearray(READ_BYTES)
        self._tls = context.wrap_bio(self._in, self._out, server_side=True)
        self._server = server
        self._seldom = seldom
        self._plain_answer = plain_answer
        self._began = self._agreed = self._paused = False
        self._raw: asyncio.Transport

    # --- called by asyncio ---

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        assert isinstance(transport, asyncio.Transport)
        self._raw = transport
        self.inner.connection_made(TlsTransport(self, transport))

    def connection_lost(self, exc: Exception | None) -> None:
        self.inner.connection_lost(exc)

    def get_buffer(self, sizehint: int) -> bytearray:
        return self._read

    def buffer_updated(self, nbytes: int) -> None:
        if not self._began and self._read[0] != HANDSHAKE:
            self._raw.write(self._plain_answer)
            self._give_up("speaks no TLS to a port that speaks nothing else")
            return
        self._began = True
        self._in.write(memoryview(self._read)[:nbytes])
        self.go_on()

    def eof_received(self) -> None:
        self.inner.eof_received()

    def pause_writing(self) -> None:
        self.inner.pause_writing()

    def resume_writing(self) -> None:
        self.inner.resume_writing()

    # --- called by the transport of `inner` ---

    def certificate(self) -> dict[str, Any]:
        """The client's certificate; empty if none was requested or shown."""
        return self._tls.getpeercert() or {} if self._agreed else {}

    def pause(self) -> None:
        self._paused = True
        self._raw.pause_reading()

    def resume(self) -> None:
        if self._paused:
            self._paused = False
            self._raw.resume_reading()
            asyncio.get_running_loop().call_soon(self.go_on)

    def write(self, data: bytes | bytearray | memoryview) -> None:
        if self._raw.is_closing():
            return
        left = memoryview(data)
        while left:
            left = left[self._tls.write(left) :]
        self._flush()

    def close(self) -> None:
        if self._agreed and not self._raw.is_closing():
            with suppress(ssl.SSLError):  # without a close_notify, which nobody has to send
                self._tls.unwrap()
            self._flush()
        self._raw.close()

    def go_on(self) -> None:
        """Hand over the data received, until `inner` pauses."""
        try:
            if not self._agreed:
                self._tls.do_handshake()
                self._agreed = True
            while not (self._paused or self._raw.is_closing()) and self._hand_over():
                pass
        except ssl.SSLWantReadError:
            self._flush()
        except ssl.SSLError as error:
            self._flush()  # send the other end the TLS alert
            self._give_up("" if self._agreed else _why(error))
        else:
            self._flush()

    def _hand_over(self) -> int:
        """Hand decrypted bytes to the inner protocol; returns their number, 0 once the other end closed."""
        if isinstance(self.inner, asyncio.BufferedProtocol):
            buffer = self.inner.get_buffer(READ_BYTES)
            count = int(self._tls.read(len(buffer), buffer))  # type: ignore[arg-type]
            if count:
                self.inner.buffer_updated(count)
        else:
            data = self._tls.read(READ_BYTES)
            count = len(data)
            if count:
                self.inner.data_received(data)
        if not count:
            self.inner.eof_received()
            self.close()
        return count

    def _flush(self) -> None:
        if self._out.pending and not self._raw.is_closing():
            self._raw.write(self._out.read())

    def _give_up(self, why: str) -> None:
        if why and self._seldom.is_due(why, asyncio.get_running_loop().time()):
            peer = (self._raw.get_extra_info("peername") or ("somebody",))[0]
            LOG.warning("%s: a client at %s %s", self._server, plain(str(peer)), plain(why))
        self._raw.close()


class TlsTransport(asyncio.Transport):
    """Transport for a protocol that runs over TLS."""

    def __init__(self, layer: TlsLayer, raw: asyncio.Transport) -> None:
        self._layer = layer
        self._raw = raw
        self._known: dict[str, Callable[[], Any]] = {
            "sslcontext": lambda: layer._tls.context,
            "peercert": layer.certificate,
        }

    def get_extra_info(self, name: str, default: Any = None) -> Any:
        return self._known[name]() if name in self._known else self._raw.get_extra_info(name, default)

    def set_protocol(self, protocol: asyncio.BaseProtocol) -> None:
        self._layer.inner = protocol

    def get_protocol(self) -> asyncio.BaseProtocol:
        return self._layer.inner  # type: ignore[no-any-return]

    def is_closing(self) -> bool:
        return self._raw.is_closing()

    def pause_reading(self) -> None:
        self._layer.pause()

    def resume_reading(self) -> None:
        self._layer.resume()

    def get_write_buffer_size(self) -> int:
        return self._raw.get_write_buffer_size()

    def set_write_buffer_limits(self, high: int | None = None, low: int | None = None) -> None:
        self._raw.set_write_buffer_limits(high, low)

    def write(self, data: bytes | bytearray | memoryview) -> None:
        self._layer.write(data)

    def close(self) -> None:
        self._layer.close()

    def abort(self) -> None:
        self._raw.abort()


def _why(error: ssl.SSLError) -> str:
    if isinstance(error, ssl.SSLCertVerificationError):
        return f"shows a certificate that is not believed: {error.verify_message}"
    return REFUSALS.get(error.reason or "", f"does not come to TLS with it: {error.reason}")
