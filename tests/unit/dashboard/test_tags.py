"""Markup of the page, from tags to HTML."""

from __future__ import annotations

from arboleda.dashboard.tags import markup, tag


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
