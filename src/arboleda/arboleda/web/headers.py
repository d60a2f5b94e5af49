"""Security headers of every answer: no framing, no guessing of types, scripts from this server only."""

from __future__ import annotations

from starlette.datastructures import MutableHeaders
from starlette.types import Message, Scope, Send

from .request_head import LOGIN, LOGOUT, is_api

# NiceGUI's pages carry scripts in them, and Vue compiles templates in the browser.
PAGE_POLICY = "; ".join(
    (
        "default-src 'self'",
        "script-src 'self' 'unsafe-inline' 'unsafe-eval'",
        "style-src 'self' 'unsafe-inline'",
        "img-src 'self' data: blob:",
        "font-src 'self' data:",
        "connect-src 'self'",
        "object-src 'none'",
        "base-uri 'self'",
        "form-action 'self'",
        "frame-ancestors 'none'",
    )
)
PLAIN_POLICY = "default-src 'none'; frame-ancestors 'none'; base-uri 'none'"
ALWAYS = {
    "x-content-type-options": "nosniff",
    "x-frame-options": "DENY",
    "referrer-policy": "same-origin",  # with no-referrer a form of ours would come from Origin "null"
    "cross-origin-opener-policy": "same-origin",
    "cross-origin-resource-policy": "same-origin",
}


def with_headers(scope: Scope, send: Send) -> Send:
    """A `send` that adds them; an answer may bring a policy of its own."""
    plain = is_api(scope["path"]) or scope["path"] in (LOGIN, LOGOUT)

    async def send_with_headers(message: Message) -> None:
        if message["type"] in ("http.response.start", "websocket.http.response.start"):
            headers = MutableHeaders(scope=message)
            headers.update(ALWAYS)
            headers.setdefault("content-security-policy", PLAIN_POLICY if plain else PAGE_POLICY)
            if plain:
                headers["cache-control"] = "no-store"
        await send(message)

    return send_with_headers
