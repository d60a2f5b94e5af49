"""Answers of plain data and sentences."""

from __future__ import annotations

import json
from typing import Any

from fastapi.responses import JSONResponse

from arboleda.core.sentence import in_json


class PlainJson(JSONResponse):
    """As FastAPI's, with the text of a sentence where one stands."""

    def render(self, content: Any) -> bytes:
        text = json.dumps(
            content, ensure_ascii=False, allow_nan=False, separators=(",", ":"), default=in_json
        )
        return text.encode("utf-8")
