"""Markup of the page: tags, the form for tasks, and the packages that are imported for it."""

from __future__ import annotations

import importlib
import sys

import pytest

from arboleda.dashboard import task_form
from arboleda.dashboard.tags import markup, tag
from arboleda.dashboard.toolkit import without
from arboleda.dashboard.wording import words
from arboleda.testing import shipped
from arboleda.views import view


def test_what_is_inside_stands_inside() -> None:
    def build() -> None:
        with tag("ul", classes="verbs  many"):
            tag("li", "Stop")
            tag("li", data_verb="clear")

    assert markup(build) == '<ul class="verbs many"><li>Stop</li><li data-verb="clear"></li></ul>'


def test_text_and_attributes_are_never_html() -> None:
    def build() -> None:
        tag("p", "<b>&", title='"><script>')

    assert markup(build) == '<p title="&quot;&gt;&lt;script&gt;">&lt;b&gt;&amp;</p>'


def test_a_field_has_no_end() -> None:
    assert markup(lambda: tag("input", for_="x")) == '<input for="x">'


def test_a_module_is_missing_meanwhile_and_there_afterwards(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delitem(sys.modules, "colorsys", raising=False)
    with without("colorsys"), pytest.raises(ImportError):
        importlib.import_module("colorsys")
    assert importlib.import_module("colorsys").rgb_to_hsv


def test_a_module_that_is_there_already_stays() -> None:
    with without("json"):
        assert importlib.import_module("json").loads("1") == 1


def test_an_end_of_a_path_has_its_letter() -> None:
    html = markup(lambda: task_form.build(view.layout(shipped()), words("en")))
    for label in ("6 A", "7 B", "8 C"):
        assert f'title="node {label[0]}: an end">{label}</button>' in html
    assert 'title="node 0: a start">0</button>' in html
