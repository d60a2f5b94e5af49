from __future__ import annotations

import time

import pytest

from arboleda.recipes.of_files import Mark
from arboleda_trees.bt_xml.findings import XmlFault
from arboleda_trees.bt_xml.markup import DEEPEST, parse


def test_values_are_as_meant_and_attributes_know_their_places() -> None:
    root = parse('<root>\n  <Ñandú name="a &lt; b"\n    code="x:=&#65; &amp;&amp; y"/></root>'.encode()).root
    (child,) = root.children
    assert child.name == "Ñandú" and child.mark == Mark(2, 3)
    assert child.value("name") == "a < b" and child.attributes["name"].mark == Mark(2, 10)
    assert child.value("code") == "x:=A && y" and child.attributes["code"].mark == Mark(3, 5)


def test_elements_know_the_bytes_of_their_tags() -> None:
    content = '<root><!-- <ñ> --><A x="/>"><B/></A ><C y="ñ>"></C></root>'.encode()
    a, c = parse(content).root.children
    assert content[a.span.start : a.span.head] == b'<A x="/>">'
    assert content[a.span.tail : a.span.end] == b"</A >"
    assert content[c.span.start : c.span.head] == '<C y="ñ>">'.encode()
    assert content[c.span.tail : c.span.end] == b"</C>" and not c.span.is_empty
    (b,) = a.children
    assert content[b.span.start : b.span.end] == b"<B/>" and b.span.is_empty


def test_what_behaviortree_cpp_takes_besides_is_read_and_named() -> None:
    found = parse(
        b"\n<?xml version='1.0'?><!-- a -- b & c --><r a='1 && 2' b=\"x < 3\">Q&A <![CDATA[<]]></r>"
    )
    assert found.root.value("a") == "1 && 2" and found.root.value("b") == "x < 3"
    assert [letter for _, letter in found.raw] == ["&", "&", "<"]
    assert found.raw[0][0] == Mark(2, 49)


@pytest.mark.parametrize(
    ("content", "line", "column", "words"),
    [
        (b"<root>\n  <A></B>\n</root>", 2, 8, "mismatched tag"),
        (b"<root>\n<A b=1/></root>", 2, 6, "not well-formed"),
        (b"<a b='1' b='2'/>", 1, 10, "duplicate attribute"),
        (b"", 1, 1, "no element found"),
        (b"cells: {}", 1, 1, "an XML file begins with a tag"),
        (b"<r>\n<!-- never", 2, 1, "a comment begins here and never ends"),
        (b"<r>\xff</r>", 1, 4, "UTF-8"),
        (b"<r a='&#0;'/>", 1, 7, "character number"),
    ],
)
def test_what_is_no_xml_is_refused_with_its_place(content: bytes, line: int, column: int, words: str) -> None:
    with pytest.raises(XmlFault, match=words) as refused:
        parse(content)
    assert refused.value.mark == Mark(line, column)


@pytest.mark.parametrize(
    "content",
    [
        b'<!DOCTYPE r [<!ENTITY a "b"><!ENTITY c "&a;&a;&a;&a;">]><r x="&c;"/>',
        b'<!DOCTYPE r SYSTEM "file:///etc/passwd"><r/>',
        b'<r/><!DOCTYPE r [<!ENTITY x SYSTEM "file:///etc/passwd">]>',
    ],
)
def test_a_document_type_is_refused_so_nothing_expands_and_nothing_is_fetched(content: bytes) -> None:
    with pytest.raises(XmlFault, match="document type"):
        parse(content)


def test_an_entity_that_nobody_declared_is_text() -> None:
    assert parse(b'<r x="&secret;"/>').root.value("x") == "&secret;"


def test_nesting_has_a_limit() -> None:
    with pytest.raises(XmlFault, match="nested deeper"):
        parse(b"<a>" * (DEEPEST + 1) + b"</a>" * (DEEPEST + 1))


@pytest.mark.sampled(4)
@pytest.mark.parametrize("part", [b"<a ", b"<!--", b"<a b='", b"<a '\"", b"<?", b'"<a', b"<a b='&'/>"])
def test_half_a_mebibyte_of_rubbish_takes_no_time(part: bytes) -> None:
    before = time.process_time()
    with pytest.raises(XmlFault):
        parse(part * (512 * 1024 // len(part)))
    assert time.process_time() - before < 5
