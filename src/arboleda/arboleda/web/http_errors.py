"""Refusals of the HTTP server, as exceptions."""

from __future__ import annotations

from starlette.responses import JSONResponse, Response


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
