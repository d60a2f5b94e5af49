"""TLS between a connection and its protocol, in memory: who is believed, and what the server's log says."""

from __future__ import annotations

import asyncio
import logging
import ssl
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import pytest
from tests.tls_lab import Lab

from arboleda.adapters.rate_limit import RateLimit
from arboleda.adapters.server_tls import ServerTls, server_tls
from arboleda.adapters.tls_layer import READ_BYTES, TlsLayer

SAID = "the broker: a client at 192.0.2.7 "


class Raw(asyncio.Transport):
    """The connection below TLS."""

    def __init__(self) -> None:
        super().__init__({"peername": ("192.0.2.7", 5)})
        self.written = bytearray()
        self.is_over = False

    def write(self, data: bytes | bytearray | memoryview) -> None:
        self.written += data

    def close(self) -> None:
        self.is_over = True

    abort = close

    def is_closing(self) -> bool:
        return self.is_over

    def pause_reading(self) -> None: ...
    def resume_reading(self) -> None: ...


class Inner(asyncio.Protocol):
    """What is above TLS; it keeps what comes."""

    def __init__(self) -> None:
        self.got = bytearray()

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = transport

    def data_received(self, data: bytes) -> None:
        self.got += data


class Talk:
    """A server's end of a connection, and the TLS of a client; `piece` is how much comes at once."""

    def __init__(self, server: ServerTls, client: ssl.SSLContext, *, piece: int = READ_BYTES) -> None:
        self.inner, self.raw = Inner(), Raw()
        self.layer = TlsLayer(server.context, self.inner, server="the broker", seldom=RateLimit())
        self.layer.connection_made(self.raw)
        self._in, self._out, self._piece = ssl.MemoryBIO(), ssl.MemoryBIO(), piece
        self.client = client.wrap_bio(self._in, self._out, server_hostname="127.0.0.1")

    def carry(self) -> None:
        """What the client has written comes, and what is answered is there for it."""
        data = self._out.read()
        for at in range(0, len(data), self._piece):
            self.come(data[at : at + self._piece])
        self._in.write(bytes(self.raw.written))
        self.raw.written.clear()

    def come(self, data: bytes) -> None:
        self.layer.get_buffer(-1)[: len(data)] = data
        self.layer.buffer_updated(len(data))

    def agree(self) -> None:
        """The handshake; ssl.SSLError where the client does not believe the server."""
        for _ in range(3):
            try:
                with suppress(ssl.SSLWantReadError):
                    self.client.do_handshake()
            finally:
                self.carry()


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(tmp_path / "lab")


@pytest.fixture(autouse=True)
def _loop(monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture) -> None:
    """Each talk is at one instant."""
    loop = SimpleNamespace(time=lambda: 0.0, call_soon=lambda call, *args: call(*args))
    monkeypatch.setattr(asyncio, "get_running_loop", lambda: loop)
    caplog.set_level(logging.WARNING)


def believing(authority: Path | None, shown: tuple[Path, Path] | None = None) -> ssl.SSLContext:
    context = ssl.create_default_context(cafile=authority)
    if shown is not None:
        context.load_cert_chain(*shown)
    return context


@pytest.mark.parametrize(
    ("name", "days", "believes", "words"),
    [
        ("127.0.0.1", -1, True, "it has expired"),
        ("mill.lab", 1, True, "it may lack the name"),
        ("127.0.0.1", 1, False, "give it the file of the authority"),
    ],
    ids=["expired", "wrong host", "unknown authority"],
)
def test_who_does_not_believe_it_is_told_of(
    lab: Lab, caplog: pytest.LogCaptureFixture, name: str, days: int, believes: bool, words: str
) -> None:
    talk = Talk(server_tls(*lab.sign(name, days=days)), believing(lab.certificate if believes else None))
    with pytest.raises(ssl.SSLCertVerificationError):
        talk.agree()
    assert talk.raw.is_over
    (line,) = caplog.messages
    assert line.startswith(f"{SAID}does not believe this certificate") and words in line


def test_who_speaks_no_tls_is_told_of(lab: Lab, caplog: pytest.LogCaptureFixture) -> None:
    talk = Talk(server_tls(*lab.sign("127.0.0.1")), believing(None))
    talk.come(b"\x10\x0d\x00\x04MQTT")
    assert talk.raw.is_over and not talk.inner.got
    assert caplog.messages == [f"{SAID}speaks no TLS to a port that speaks nothing else"]


def test_a_certificate_of_another_authority_is_told_of(
    lab: Lab, tmp_path: Path, caplog: pytest.LogCaptureFixture
) -> None:
    server = server_tls(*lab.sign("127.0.0.1"), authority=lab.certificate)
    talk = Talk(server, believing(lab.certificate, Lab(tmp_path / "other").sign("ra_1")))
    with suppress(ssl.SSLError):  # an alert
        talk.agree()
    assert talk.raw.is_over
    (line,) = caplog.messages
    assert line.startswith(f"{SAID}shows a certificate that is not believed: ")


def test_the_name_in_a_certificate_is_known_once_it_is_believed(lab: Lab) -> None:
    server = server_tls(*lab.sign("127.0.0.1"), authority=lab.certificate)
    talk = Talk(server, believing(lab.certificate, lab.sign("ra_1")))
    assert talk.layer.certificate() == {}
    talk.agree()
    assert (("commonName", "ra_1"),) in talk.layer.certificate()["subject"]


def test_a_connection_is_known_before_its_handshake(lab: Lab) -> None:
    """Who only connects is counted, and can make room for others."""
    talk = Talk(server_tls(*lab.sign("127.0.0.1")), believing(lab.certificate))
    talk.inner.transport.abort()
    assert talk.raw.is_over


@pytest.mark.parametrize("piece", [7, 700, READ_BYTES])
def test_what_comes_in_pieces_and_much_at_once_arrives_whole(lab: Lab, piece: int) -> None:
    talk = Talk(server_tls(*lab.sign("127.0.0.1")), believing(lab.certificate), piece=piece)
    talk.agree()
    sent = bytes(range(256)) * 200
    talk.client.write(sent[: len(sent) // 2])
    talk.client.write(sent[len(sent) // 2 :])
    talk.carry()
    assert bytes(talk.inner.got) == sent
