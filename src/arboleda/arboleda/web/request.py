"""Requests of the HTTP server: their head, the security headers of answers, refusals."""

from __future__ import annotations

import re
from http.cookies import CookieError, SimpleCookie

from starlette.datastructures import MutableHeaders
from starlette.responses import JSONResponse, Response
from starlette.types import Message, Scope, Send

from .access.names import is_loopback

API, LOGIN, LOGOUT, METRICS = "/api/", "/login", "/logout", "/metrics"
PAGE, TASK, HISTORY, SCENE = "/", "/task.json", "/history.json", "/twin/scene.json"  # of the page
STOP = re.compile(r"/api/(plant|cells/[^/]+|plants(/[^/]+)?)/stop")
READS = {"GET", "HEAD"}
ONLY_ONE = {"host", "origin", "authorization", "cookie", "content-length", "transfer-encoding"}
FORWARDED = {"forwarded", "via", "x-forwarded-for", "x-forwarded-host", "x-forwarded-proto", "x-real-ip"}


def is_api(path: str) -> bool:
    """True if a path belongs to the API, even if there is no such route."""
    return path in (API.rstrip("/"), METRICS) or path.startswith(API)


def is_stop(method: str, path: str) -> bool:
    """True if a request is a stop, which is made before all else."""
    return method == "POST" and bool(STOP.fullmatch(path))


class RequestHead:
    """HTTP request or websocket handshake; header values are latin-1, "" if missing."""

    def __init__(self, scope: Scope) -> None:
        self.scope = scope
        self._headers = [
            (name.decode("latin-1"), value.decode("latin-1", "replace")) for name, value in scope["headers"]
        ]
        self._first: dict[str, str] = dict(reversed(self._headers))

    def header(self, name: str) -> str:
        return self._first.get(name, "")

    def has(self, *names: str) -> bool:
        return any(name in self._first for name in names)

    @property
    def header_bytes(self) -> int:
        target = len(self.scope.get("raw_path") or b"") + len(self.scope["query_string"])
        return target + sum(len(name) + len(value) + 4 for name, value in self._headers)

    @property
    def ambiguous(self) -> bool:
        """True if two readers could disagree on this request: on who asks, or on where its body ends."""
        names = [name for name, _ in self._headers if name in ONLY_ONE]
        return len(names) > len(set(names)) or (self.has("content-length") and self.has("transfer-encoding"))

    @property
    def socket(self) -> bool:
        return bool(self.scope["type"] == "websocket")

    @property
    def path(self) -> str:
        return str(self.scope["path"])

    def at(self, path: str) -> str:
        """The same query at a path of this server, so that a login leads to the page asked for."""
        query = self.scope["query_string"].decode("latin-1")
        return f"{path}?{query}" if query else path

    @property
    def reads(self) -> bool:
        """True if the request only reads. A websocket never counts as such."""
        return not self.socket and self.scope["method"] in READS

    @property
    def stops(self) -> bool:
        return not self.socket and is_stop(self.scope["method"], self.path)

    @property
    def for_api(self) -> bool:
        return not self.socket and is_api(self.path)

    @property
    def for_page(self) -> bool:
        return not is_api(self.path) and self.path not in (LOGIN, LOGOUT)

    @property
    def opens_page(self) -> bool:
        """True if the request is for a page itself, not for one of the files of pages."""
        return not self.socket and self.path == PAGE

    @property
    def logs_in(self) -> bool:
        return not self.socket and self.path == LOGIN

    @property
    def forwarded(self) -> bool:
        return self.has(*FORWARDED)

    @property
    def from_elsewhere(self) -> bool:
        """True if a browser says that a page of another origin embeds or fetches this."""
        site, mode = self.header("sec-fetch-site"), self.header("sec-fetch-mode")
        return site in ("cross-site", "same-site") and mode != "navigate"

    @property
    def wants_page(self) -> bool:
        return self.reads and self.for_page and "text/html" in self.header("accept")

    @property
    def bearer(self) -> bytes | None:
        kind, _, token = self.header("authorization").partition(" ")
        return token.strip().encode("latin-1", "replace") if kind.lower() == "bearer" else None

    @property
    def session(self) -> str | None:
        """The value of the login cookie; None if there is none."""
        try:
            cookie = SimpleCookie(self.header("cookie")).get(cookie_name(self.scope))
        except CookieError:
            return None
        return cookie.value if cookie is not None else None

    def peer(self, *, proxied: bool) -> str:
        """The address that the request comes from; behind a proxy of this machine, that which the proxy saw.

        IPv6 addresses count by their network.
        """
        address = (self.scope.get("client") or ("",))[0]
        if proxied and address and is_loopback(address) and self.has("x-forwarded-for"):
            address = [value for name, value in self._headers if name == "x-forwarded-for"][-1]
            address = address.rpartition(",")[2].strip()
        groups = address.split(":")
        return ":".join(groups[:4]) if len(groups) > 4 and "." not in address else address


def cookie_name(scope: Scope) -> str:
    """The name of the login cookie, with the port: browsers send the cookies of all ports of a machine."""
    return f"arboleda_{(scope.get('server') or ('', 0))[1]}"


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


class HttpError(Exception):
    """Error: the request is refused with a status, a sentence, and headers such as `retry_after="1"`."""

    def __init__(self, status: int, sentence: str, **headers: str) -> None:
        super().__init__(sentence)
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        self.answer: Response = JSONResponse(
            {"sentence": sentence}, status_code=status, headers={"connection": "close", **named}
        )


class ClientGone(Exception):
    """Error: the client left before its request was complete; there is nobody to answer."""
