"""The snapshot as JSON, written row by row: the encoder of all of it holds Python's lock until it is done."""

from __future__ import annotations

import json
from collections.abc import Generator, Mapping
from typing import Any

from arboleda.model.sentence import in_json

_encode = json.JSONEncoder(ensure_ascii=False, default=in_json).encode


def in_parts(snapshot: Mapping[str, Any]) -> Generator[None, None, str]:
    """The same text as of `json.dumps`, with letters beyond ASCII as they are; a part is a row of a list."""
    members = []
    for key, value in snapshot.items():
        if isinstance(value, list):
            rows = []
            for row in value:
                rows.append(_encode(row))
                yield
            text = f"[{', '.join(rows)}]"
        else:
            text = _encode(value)
        members.append(f"{_encode(key)}: {text}")
    return "{" + ", ".join(members) + "}"
