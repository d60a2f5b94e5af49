"""How somebody is turned away."""

from __future__ import annotations

from starlette.responses import JSONResponse, Response


class HttpError(Exception):
    """Turned away with this answer: a status, one sentence, and headers such as `retry_after="1"`."""

    def __init__(self, status: int, sentence: str, **headers: str) -> None:
        super().__init__(sentence)
        named = {name.replace("_", "-"): value for name, value in headers.items()}
        self.answer: Response = JSONResponse(
            {"sentence": sentence}, status_code=status, headers={"connection": "close", **named}
        )


class ClientGone(Exception):
    """The client went away before it had asked; there is nobody to answer."""
