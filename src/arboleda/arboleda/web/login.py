"""Login by a token in a form; afterwards by a cookie that scripts cannot read."""

from __future__ import annotations

from html import escape
from urllib.parse import parse_qsl

from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, RedirectResponse, Response

from .auth import SESSION_S
from .plain_page import page
from .request_head import LOGIN, LOGOUT, RequestHead, cookie_name

WORDS = {
    "en": {
        "title": "Log in to the plant",
        "token": "Token",
        "hint": "On the plant's machine, arboleda token shows it.",
        "enter": "Log in",
        "wrong": "This token is not valid.",
    },
    "es": {
        "title": "Entrar en la planta",
        "token": "Clave",
        "hint": "En la máquina de la planta la muestra arboleda token.",
        "enter": "Entrar",
        "wrong": "Esta clave no es válida.",
    },
}


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


def _cookie(request: Request) -> dict[str, object]:
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
    asked = request.query_params.get("lang") or request.headers.get("accept-language", "")
    language = "es" if asked.lower().startswith("es") else "en"
    words = {key: escape(value) for key, value in WORDS[language].items()}
    trouble = f'<p role="alert">{words["wrong"]}</p>' if wrong else ""
    to = escape(RequestHead(request.scope).at(LOGIN))
    body = f"""<h1>{words["title"]}</h1>{trouble}<form method="post" action="{to}">
<p><label>{words["token"]}
<input name="token" type="password" autocomplete="current-password" required autofocus></label></p>
<p>{words["hint"]}</p><p><button>{words["enter"]}</button></p></form>"""
    return page(WORDS[language]["title"], body, language=language, status=401 if wrong else 200)
