"""Pages without scripts: everything that comes in is escaped, and the style is the only one allowed."""

from __future__ import annotations

import hashlib
from base64 import b64encode
from html import escape

from fastapi.responses import HTMLResponse

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
