"""Answers of plain data and sentences."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import Any

from fastapi.responses import JSONResponse

from arboleda.model.sentence import OWN, Sentence, in_json


class PlainJson(JSONResponse):
    """JSON answer as FastAPI's, with a Sentence written as its text."""

    def render(self, content: Any) -> bytes:
        text = json.dumps(
            content, ensure_ascii=False, allow_nan=False, separators=(",", ":"), default=in_json
        )
        return text.encode("utf-8")


def explained(row: Mapping[str, Any]) -> dict[str, Any]:
    """A row with the parts of its `sentence`, `key` and `values`; unchanged if that is text only."""
    sentence = row["sentence"]
    by_key = isinstance(sentence, Sentence) and sentence and sentence.phrase is not OWN
    return {**row, **sentence.data()} if by_key else {**row}
