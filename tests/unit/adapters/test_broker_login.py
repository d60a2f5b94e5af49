"""Where the broker is, who the plant is for one that asks, and whom the plant believes."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

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
