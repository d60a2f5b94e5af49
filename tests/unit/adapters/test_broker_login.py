"""Where the broker is, who the plant is for one that asks, and whom its own broker is opened to."""

from __future__ import annotations

import errno
import os
import re
from pathlib import Path

import pytest

from arboleda.adapters import descriptors
from arboleda.adapters.broker import EmbeddedBroker
from arboleda.adapters.broker_login import CA, CERTIFICATE, KEY, PASSWORD, USER, Credentials, address, login
from arboleda.model.errors import StartError


@pytest.fixture(autouse=True)
def _nothing_said(monkeypatch: pytest.MonkeyPatch) -> None:
    for name in (CA, CERTIFICATE, KEY):
        monkeypatch.delenv(name, raising=False)


def test_the_environment_names_user_and_password(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(USER, "plant")
    monkeypatch.setenv(PASSWORD, "secret")
    assert login() == Credentials(user="plant", password="secret")


def test_a_password_without_a_user_is_no_login(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(USER, raising=False)
    monkeypatch.setenv(PASSWORD, "secret")
    assert login() is None


@pytest.mark.parametrize(
    ("text", "reads"),
    [
        ("mqtts://broker.lab", "mqtts://broker.lab:8883"),
        ("mqtts://[::1]:2883", "mqtts://[::1]:2883"),
        ("mqtt://broker.lab", "broker.lab:1883"),
        ("broker.lab:2883", "broker.lab:2883"),
    ],
)
def test_an_address_reads_as_it_is_written(text: str, reads: str) -> None:
    assert str(address(text)) == reads
    assert str(address(reads)) == reads


@pytest.mark.parametrize(
    ("variable", "content"), [(CA, None), (CA, "no certificate"), (CERTIFICATE, "nor this")]
)
def test_a_file_that_is_of_no_use_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, variable: str, content: str | None
) -> None:
    path = tmp_path / "file.pem"
    if content is not None:
        path.write_text(content)
    monkeypatch.setenv(variable, str(path))
    with pytest.raises(StartError, match=re.escape(str(path))):
        address("mqtts://broker.lab")


def test_a_key_without_its_certificate_is_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setenv(KEY, str(tmp_path / "key.pem"))
    with pytest.raises(StartError, match=re.escape(f"name that in ${CERTIFICATE}")):
        address("mqtts://broker.lab")


USERS = {"ra_1": "one"}


@pytest.mark.parametrize("host", ["0.0.0.0", "192.0.2.1", "example.org", "::"])
def test_other_machines_are_let_in_only_with_users(host: str) -> None:
    with pytest.raises(StartError, match="give it a user and a password"):
        EmbeddedBroker(host, 0).start()


@pytest.mark.parametrize("users", [{"arboleda": "x"}, {"ra_1": ""}, {"": "x"}])
def test_useless_users_are_refused(users: dict[str, str]) -> None:
    with pytest.raises(StartError):
        EmbeddedBroker(port=0, users=users).start()


@pytest.mark.parametrize(
    ("trouble", "sentence"),
    [(errno.EADDRNOTAVAIL, "Cannot assign requested address"), (errno.EADDRINUSE, "the port is taken")],
)
def test_where_it_cannot_listen_is_one_sentence(
    monkeypatch: pytest.MonkeyPatch, trouble: int, sentence: str
) -> None:
    def listener(host: str, port: int) -> None:
        raise OSError(trouble, os.strerror(trouble))

    monkeypatch.setattr(descriptors, "listener", listener)
    broker = EmbeddedBroker("192.0.2.1", 5, users=USERS)
    broker.stop()  # before its start there is nothing to stop
    with pytest.raises(StartError) as refused:
        broker.start()
    assert str(refused.value) == f"The broker cannot listen on 192.0.2.1:5: {sentence}."


def test_the_plants_password_is_new_at_each_start_and_not_shown() -> None:
    first, second = (EmbeddedBroker(users=USERS).credentials for _ in range(2))
    assert first.password != second.password
    assert first.password not in repr(first)
