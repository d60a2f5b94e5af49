"""Answers of plain data."""

from __future__ import annotations

import json
from typing import Any

from fastapi.responses import JSONResponse

from arboleda.model.sentence import in_json


class PlainJson(JSONResponse):
    """JSON answer as FastAPI's, with a Sentence written as its text."""

    def render(self, content: Any) -> bytes:
        text = json.dumps(
            content, ensure_ascii=False, allow_nan=False, separators=(",", ":"), default=in_json
        )
        return text.encode("utf-8")
