"""Who the plant is for a broker that asks."""

from __future__ import annotations

import pytest

from arboleda.adapters.broker_login import PASSWORD, USER, Credentials, login


def test_the_environment_names_user_and_password(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv(USER, "plant")
    monkeypatch.setenv(PASSWORD, "secret")
    assert login() == Credentials(user="plant", password="secret")


def test_a_password_without_a_user_is_no_login(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv(USER, raising=False)
    monkeypatch.setenv(PASSWORD, "secret")
    assert login() is None
