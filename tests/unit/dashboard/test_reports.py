"""The address of a report: the report, a page that waits for it, or why there is none."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import pytest
from fastapi import FastAPI
from tests.in_process import Caller, without_threads

from arboleda.dashboard import reports
from arboleda.model.errors import ArboledaError

CONTENT = "<!doctype html><p>why</p>"


@pytest.fixture
def browser(monkeypatch: pytest.MonkeyPatch) -> Caller:
    without_threads(monkeypatch)

    def report(task: str) -> str | None:
        if task == "<i>":
            raise ArboledaError("<i> is not the id of a task")
        return CONTENT if task == "lot" else None

    app = FastAPI()
    side: Any = SimpleNamespace(ask=lambda _kind: SimpleNamespace(report=report))
    reports.serve(app, side)
    return Caller(app)


def test_a_report_that_is_there_is_shown_without_any_right(browser: Caller) -> None:
    answer = browser.get("/report?task=lot")
    assert answer.status_code == 200 and answer.text == CONTENT
    assert answer.headers["content-disposition"] == 'inline; filename="lot.html"'
    assert answer.headers["content-security-policy"].startswith("sandbox allow-scripts allow-downloads; ")


def test_until_it_is_written_a_page_waits_for_it(browser: Caller) -> None:
    answer = browser.get("/report?task=other", headers={"accept-language": "es"})
    assert answer.status_code == 200 and answer.headers["refresh"] == "1"
    assert "Se está escribiendo el informe" in answer.text and "<script" not in answer.text


def test_why_there_is_none_is_a_sentence(browser: Caller) -> None:
    answer = browser.get("/report", params={"task": "<i>"})
    assert answer.status_code == 404 and "refresh" not in answer.headers
    assert "&lt;i&gt; is not the id of a task" in answer.text and "<i>" not in answer.text
