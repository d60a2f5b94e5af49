"""The address of a report: the report, a page that waits for it, or why there is none."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import httpx
import pytest
from fastapi import FastAPI

from arboleda.dashboard import reports
from arboleda.model.errors import ArboledaError

CONTENT = "<!doctype html><p>why</p>"


Get = Callable[..., httpx.Response]


@pytest.fixture
def get() -> Get:
    def report(task: str) -> str | None:
        if task == "<i>":
            raise ArboledaError("<i> is not the id of a task")
        return CONTENT if task == "lot" else None

    app, plant = FastAPI(), SimpleNamespace(report=report)
    side: Any = plant
    reports.serve(app, side)

    async def asked(task: str, language: str) -> httpx.Response:
        transport = httpx.ASGITransport(app=app)
        async with httpx.AsyncClient(transport=transport, base_url="http://plant") as client:
            return await client.get("/report", params={"task": task}, headers={"accept-language": language})

    return lambda task, language="en": asyncio.run(asked(task, language))


def test_a_report_that_is_there_is_shown_without_any_right(get: Get) -> None:
    answer = get("lot")
    assert answer.status_code == 200 and answer.text == CONTENT
    assert answer.headers["content-disposition"] == 'inline; filename="lot.html"'
    assert answer.headers["content-security-policy"].startswith("sandbox allow-scripts allow-downloads; ")


def test_until_it_is_written_a_page_waits_for_it(get: Get) -> None:
    answer = get("other", "es")
    assert answer.status_code == 200 and answer.headers["refresh"] == "1"
    assert "Se está escribiendo el informe" in answer.text and "<script" not in answer.text


def test_why_there_is_none_is_a_sentence(get: Get) -> None:
    answer = get("<i>")
    assert answer.status_code == 404 and "refresh" not in answer.headers
    assert "&lt;i&gt; is not the id of a task" in answer.text and "<i>" not in answer.text
