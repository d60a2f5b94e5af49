"""Labels of a command's message: its id, the last telemetry that the plant had heard, and its token."""

from __future__ import annotations

from collections.abc import Iterable

from arboleda.wire.status import command_id, count, token

_ID, _HEARD, _TOKEN = "id=", "heard=", "token="


def to_label(command_id: str) -> str:
    """The label of a command, `layout.dim[0].label`: `id=<command id>`."""
    return _ID + command_id


def from_label(label: str) -> str:
    """The command id of a label; "" for another label, PayloadError for an invalid id."""
    if not label.startswith(_ID):
        return ""
    return command_id("label", label[len(_ID) :])


def to_heard_label(number: int) -> str:
    """The label of the last telemetry that the plant had heard: `heard=<number>`."""
    return f"{_HEARD}{number}"


def from_heard_labels(labels: Iterable[str]) -> int | None:
    """The number in the `heard` label, None if there is no such label; PayloadError for an invalid number."""
    number = _after(_HEARD, labels)
    return None if number is None else count("heard", number)


def to_token_label(token: str) -> str:
    """The label of the token that the board is to echo: `token=<token>`."""
    return f"{_TOKEN}{token}"


def from_token_labels(labels: Iterable[str]) -> str | None:
    """The token in the `token` label, None if there is no such label; PayloadError for an invalid token."""
    found = _after(_TOKEN, labels)
    return None if found is None else token(found)


def _after(prefix: str, labels: Iterable[str]) -> str | None:
    """The text behind this prefix in the first label that has it; None where none has."""
    return next((label.removeprefix(prefix) for label in labels if label.startswith(prefix)), None)
