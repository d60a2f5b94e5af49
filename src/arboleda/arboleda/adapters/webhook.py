"""HTTP POSTs of JSON to an address chosen by the user; the address itself is a secret."""

from __future__ import annotations

import os
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

from arboleda.model.errors import ArboledaError, StartError

URL, TOKEN = "ARBOLEDA_ALARM_WEBHOOK", "ARBOLEDA_ALARM_TOKEN"  # anybody can read a command line
TIMEOUT_S = 5.0
NOT_THIS_ONE = frozenset({400, 413, 422})  # statuses that refuse this message for good


class NotDelivered(ArboledaError):
    """Error: the message did not arrive, as far as is known; it may the next time."""


class DeliveryRefused(ArboledaError):
    """Error: the receiver rejects this message, and would the next time."""


@dataclass(frozen=True, kw_only=True)
class Hook:
    """Address to post to, and the bearer token for it; `str()` shows no secret."""

    url: str = field(repr=False)
    token: str | None = field(default=None, repr=False)

    def __str__(self) -> str:
        parts = urlsplit(self.url)
        return f"{parts.scheme}://{parts.netloc.rpartition('@')[2]}"


def hook() -> Hook | None:
    """The hook from the environment, None if it has none; raises StartError for an invalid address."""
    url, token = os.environ.get(URL), os.environ.get(TOKEN) or None
    if not url:
        if token:
            raise StartError(f"${TOKEN} has a token, but ${URL} names no address to show it to")
        return None
    try:
        parts = urlsplit(url)
        good = parts.scheme in ("http", "https") and bool(parts.hostname) and parts.port != 0
    except ValueError:
        good = False
    if not good or not url.isascii() or not url.isprintable() or " " in url:
        raise StartError(f"${URL} is no address to post to; write one like https://alarms.example/hook")
    if token and not (token.isascii() and token.isprintable() and " " not in token):
        raise StartError(f"${TOKEN} is no token: it may have no spaces and nothing beyond ASCII")
    return Hook(url=url, token=token)


class Webhook:
    """Client of one hook, for one thread at a time; its libraries are loaded before a plant runs."""

    def __init__(self, hook: Hook, *, timeout_s: float = TIMEOUT_S) -> None:
        import httpx  # slow to load, and needed only for posting

        headers = {"Authorization": f"Bearer {hook.token}"} if hook.token else {}
        self._hook = hook
        self._timeout_s = timeout_s
        self._http = httpx.Client(timeout=timeout_s, headers=headers)

    def __str__(self) -> str:
        return str(self._hook)

    def post(self, what: dict[str, Any]) -> None:
        """Return once it is accepted (2xx); raises DeliveryRefused or NotDelivered, with the reason."""
        import httpx

        try:
            # Only the head of the answer is read: its body may be of any length.
            with self._http.stream("POST", self._hook.url, json=what) as answer:
                status = answer.status_code
        except httpx.TimeoutException as error:
            raise NotDelivered(f"no answer within {self._timeout_s:g} s") from error
        except (httpx.HTTPError, httpx.InvalidURL, OSError) as error:
            raise NotDelivered(str(error) or type(error).__name__) from error
        if status in NOT_THIS_ONE:
            raise DeliveryRefused(f"it answers {status}")
        if 300 <= status < 400:
            raise NotDelivered(f"it answers {status}: name the address that it leads to in ${URL}")
        if status in (401, 403):
            raise NotDelivered(f"it answers {status}: see ${TOKEN}")
        if not 200 <= status < 300:
            raise NotDelivered(f"it answers {status}")

    def close(self) -> None:
        """Close the connection; idempotent."""
        self._http.close()
