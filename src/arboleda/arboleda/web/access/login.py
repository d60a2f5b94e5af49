"""Login by a token in a form, afterwards by a cookie that scripts cannot read; pages without scripts."""

from __future__ import annotations

import hashlib
from base64 import b64encode
from html import escape
from typing import Any
from urllib.parse import parse_qsl

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, RedirectResponse, Response

from ..languages import spoken, texts
from ..request import LOGIN, LOGOUT, RequestHead, cookie_name
from .auth import SESSION_S

STYLE = """
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { margin: 2rem auto; padding: 0 1rem; max-width: 60rem; }
input, button { font: inherit; padding: .5rem; } input { width: 100%; box-sizing: border-box; }
table { border-collapse: collapse; }
td, th { text-align: left; vertical-align: top; padding: .2rem 1rem .2rem 0; }
pre { overflow-x: auto; } section { border-top: 1px solid; margin-top: 2rem; }
"""
META = '<meta charset="utf-8"><meta name="viewport" content="width=device-width">'
POLICY = (
    f"default-src 'none'; style-src 'sha256-{b64encode(hashlib.sha256(STYLE.encode()).digest()).decode()}'; "
    "form-action 'self'; frame-ancestors 'none'; base-uri 'none'"
)


def page(title: str, body: str, *, language: str = "en", status: int = 200) -> HTMLResponse:
    """A whole page around `body`, which is HTML already."""
    head = f"<title>{escape(title)}</title><style>{STYLE}</style>"
    text = f'<!doctype html><html lang="{language}"><head>{META}{head}</head><body>{body}</body></html>'
    return HTMLResponse(text, status_code=status, headers={"content-security-policy": POLICY})


def routes() -> APIRouter:
    """Register the form, login and logout."""
    pages = APIRouter(include_in_schema=False)

    @pages.get(LOGIN)
    async def form(request: Request) -> Response:
        known = request.scope["arboleda.login"]
        return RedirectResponse(RequestHead(request.scope).at("/"), 303) if known else _form(request)

    @pages.post(LOGIN)
    async def log_in(request: Request) -> Response:
        door = request.scope["arboleda.door"]
        token = _token(await request.body())
        session = door.log_in(token) if token and not door.open else None
        if session is None:
            return _form(request, wrong=True)
        answer = RedirectResponse(RequestHead(request.scope).at("/"), 303)
        answer.set_cookie(value=session, max_age=int(SESSION_S), **_cookie(request))
        return answer

    @pages.post(LOGOUT)
    async def log_out(request: Request) -> Response:
        session = RequestHead(request.scope).session
        if session is not None:
            request.scope["arboleda.door"].log_out(session)
        answer = RedirectResponse(LOGIN, 303)
        answer.delete_cookie(**_cookie(request))
        return answer

    return pages


def _cookie(request: Request) -> dict[str, Any]:
    encrypted = request.headers.get("origin", "").startswith("https://")
    name = cookie_name(request.scope)
    return {"key": name, "path": "/", "httponly": True, "samesite": "strict", "secure": encrypted}


def _token(body: bytes) -> bytes:
    """The field `token` of a form; b"" if there is none."""
    try:
        fields = dict(parse_qsl(body.decode("ascii"), max_num_fields=4))
    except ValueError:
        return b""
    return fields.get("token", "").strip().encode(errors="replace")


def _form(request: Request, *, wrong: bool = False) -> HTMLResponse:
    browser = request.headers.get("accept-language", "").split(",")
    language = spoken([request.query_params.get("lang"), *browser])
    words = {key: escape(value) for key, value in texts(language, "login").items()}
    trouble = f'<p role="alert">{words["wrong"]}</p>' if wrong else ""
    to = escape(RequestHead(request.scope).at(LOGIN))
    body = f"""<h1>{words["title"]}</h1>{trouble}<form method="post" action="{to}">
<p><label>{words["token"]}
<input name="token" type="password" autocomplete="current-password" required autofocus></label></p>
<p>{words["hint"]}</p><p><button>{words["enter"]}</button></p></form>"""
    return page(texts(language, "login")["title"], body, language=language, status=401 if wrong else 200)
