"""The certificate of a server of this process: what is read, what is said of it, and who believes it."""

from __future__ import annotations

import re
import ssl
import time
from pathlib import Path

import pytest
from tests.tls_lab import Lab

from arboleda.adapters.server_tls import pinned, server_tls
from arboleda.model.errors import StartError


@pytest.fixture
def lab(tmp_path: Path) -> Lab:
    return Lab(tmp_path / "lab")


def agree(server: ssl.SSLContext, client: ssl.SSLContext) -> None:
    """A handshake in memory; ssl.SSLError where one does not believe the other."""
    up, down = ssl.MemoryBIO(), ssl.MemoryBIO()
    ends = client.wrap_bio(down, up), server.wrap_bio(up, down, server_side=True)
    for _ in range(2):
        for end in ends:
            try:
                end.do_handshake()
            except ssl.SSLWantReadError:
                continue


@pytest.mark.parametrize("days", [1, -1], ids=["with another name", "expired"])
def test_the_plants_own_clients_believe_it_in_any_case(lab: Lab, days: int) -> None:
    tls = server_tls(*lab.sign("mill.lab", days=days))
    agree(tls.context, pinned(tls.pem))


def test_the_plants_own_clients_believe_no_other_of_that_authority(lab: Lab) -> None:
    tls, other = server_tls(*lab.sign("127.0.0.1")), server_tls(*lab.sign("127.0.0.1"))
    with pytest.raises(ssl.SSLCertVerificationError):
        agree(other.context, pinned(tls.pem))


def test_a_file_that_is_of_no_use_is_named(lab: Lab, tmp_path: Path) -> None:
    certificate, key = lab.sign("127.0.0.1")
    other = lab.sign("ra_9")[1]
    for files in ((certificate, other), (certificate, None), (tmp_path / "none", key), (key, key)):
        with pytest.raises(StartError, match=re.escape(str(files[0]))):
            server_tls(*files)
    with pytest.raises(StartError, match=re.escape(str(key))):
        server_tls(certificate, key, authority=key)


def test_an_encrypted_key_is_said_to_be(lab: Lab) -> None:
    from cryptography.hazmat.primitives.serialization import (
        BestAvailableEncryption,
        Encoding,
        PrivateFormat,
        load_pem_private_key,
    )

    certificate, key = lab.sign("127.0.0.1")
    secret = load_pem_private_key(key.read_bytes(), None)
    how = Encoding.PEM, PrivateFormat.PKCS8, BestAvailableEncryption(b"x")
    key.write_bytes(secret.private_bytes(*how))
    with pytest.raises(StartError, match="the key is encrypted; write it without password"):
        server_tls(certificate, key)


def test_key_and_certificate_may_share_a_file_and_only_the_certificate_is_passed_on(
    lab: Lab, tmp_path: Path
) -> None:
    certificate, key = lab.sign("127.0.0.1")
    both = tmp_path / "both.pem"
    both.write_text(key.read_text() + certificate.read_text())
    assert server_tls(both).pem == certificate.read_text()


@pytest.mark.parametrize(("days", "words"), [(-1, "has expired on "), (3, "expires on "), (400, None)])
def test_the_start_says_of_a_certificate_that_it_ends(lab: Lab, days: int, words: str | None) -> None:
    note = server_tls(*lab.sign("127.0.0.1", days=days)).note(time.time())
    assert note is None if words is None else note is not None and words in note
