"""Operations change what they are for; all other bytes stay, over every tree in the repository."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st
from packages.arboleda_make.tests.fast.editing.corpus import texts

from arboleda_make.editing.apply import apply
from arboleda_make.editing.errors import EditError
from arboleda_make.editing.operations import (
    AddTree,
    Extract,
    Insert,
    Move,
    NewNode,
    Remove,
    RemoveParameter,
    RemoveTree,
    RenameTree,
    Replace,
    SetAttribute,
    SetParameter,
    Unwrap,
    Wrap,
)
from arboleda_make.editing.tree_text import TreeText, kind_of, steps, walk
from arboleda_trees.bt_xml.markup import Element

COMMENT = re.compile(r"<!--.*?-->", re.DOTALL)
NEW = NewNode(kind="Sleep", attributes={"msec": "5"})
AROUND = NewNode(kind="Inverter")
VALUES = st.text(st.characters(exclude_categories=["Cs", "Cc"], exclude_characters="\ufffe\uffff"))
Shape = list[Any]


def shape(element: Element) -> Shape:
    """Kind, attributes and children of a node."""
    given_ = {name: each.value for name, each in element.attributes.items()}
    return [element.name, given_, [shape(each) for each in element.children]]


def shapes(text: str) -> dict[str, list[Shape]]:
    found = TreeText(text).trees
    return {name: [shape(each) for each in tree.children] for name, tree in found.items()}


def below(tree: list[Shape], path: str) -> tuple[list[Shape], int]:
    """The list in which a node is, and where."""
    level, index = tree, 0
    for step in steps(path):
        level, index = level[index][2], step
    return level, index


@st.composite
def places(draw: st.DrawFn) -> tuple[str, str, str]:
    """A text, one of its trees and one of the nodes there."""
    text = draw(st.sampled_from(texts()))
    trees = {name: tree for name, tree in TreeText(text).trees.items() if tree.children}
    name = draw(st.sampled_from(sorted(trees)))
    return text, name, draw(st.sampled_from([path for path, _ in walk(trees[name])]))


@pytest.mark.long
def test_there_are_trees_to_try() -> None:
    assert len(texts()) > 500


@given(places())
def test_a_new_node_is_where_it_is_wanted_and_gone_again_nothing_is_left_of_it(
    place: tuple[str, str, str],
) -> None:
    text, tree, path = place
    holder = TreeText(text).node(tree, path)
    for index in range(len(holder.children) + 1):
        changed = apply(text, Insert(tree=tree, parent=path, index=index, node=NEW))
        wanted = shapes(text)
        level, at = below(wanted[tree], path)
        level[at][2].insert(index, ["Sleep", {"msec": "5"}, []])
        assert shapes(changed) == wanted
        assert COMMENT.findall(changed) == COMMENT.findall(text)
        gone = apply(changed, Remove(tree=tree, path=f"{path}.{index}".removeprefix("root.")))
        if not holder.span.is_empty:
            assert gone == text


@given(places(), VALUES)
def test_a_value_is_what_was_said_and_nothing_else_changes(place: tuple[str, str, str], value: str) -> None:
    text, tree, path = place
    element = TreeText(text).node(tree, path)
    for name in [each for each in element.attributes if each not in ("ID", "name")]:
        changed = apply(text, SetAttribute(tree=tree, path=path, name=name, value=value))
        assert TreeText(changed).node(tree, path).value(name) == value
        back = apply(changed, SetAttribute(tree=tree, path=path, name=name, value=element.value(name)))
        assert shapes(back) == shapes(text) and len(back.splitlines()) == len(text.splitlines())
    added = apply(text, SetAttribute(tree=tree, path=path, name="_new", value=value))
    assert TreeText(added).node(tree, path).value("_new") == value
    assert apply(added, SetAttribute(tree=tree, path=path, name="_new", value=None)) == text


@given(places())
def test_what_was_put_around_a_node_and_taken_away_leaves_nothing(place: tuple[str, str, str]) -> None:
    text, tree, path = place
    around = apply(text, Wrap(tree=tree, path=path, node=AROUND))
    wanted = shapes(text)
    level, at = below(wanted[tree], path)
    level[at] = ["Inverter", {}, [level[at]]]
    assert shapes(around) == wanted
    assert apply(around, Unwrap(tree=tree, path=path)) == text


@given(places(), st.data())
def test_a_node_that_moves_is_the_same_elsewhere(place: tuple[str, str, str], data: st.DataObject) -> None:
    text, tree, path = place
    to = data.draw(st.sampled_from([each for each, _ in walk(TreeText(text).tree(tree))]))
    index = data.draw(st.integers(0, len(TreeText(text).node(tree, to).children)))
    edit = Move(tree=tree, path=path, to_tree=tree, parent=to, index=index)
    if path == "root" or steps(to)[: len(steps(path))] == steps(path):
        with pytest.raises(EditError, match="into itself"):
            apply(text, edit)
        return
    wanted = shapes(text)
    (from_level, at), (holders, holder) = below(wanted[tree], path), below(wanted[tree], to)
    moved, mark = from_level[at], ["mark"]
    from_level[at] = mark
    holders[holder][2].insert(index, moved)
    next(level.remove(mark) for level in levels(wanted[tree]) if mark in level)
    changed = apply(text, edit)
    assert shapes(changed) == wanted
    assert sorted(COMMENT.findall(changed)) == sorted(COMMENT.findall(text))
    copied = apply(text, replace(edit, stays=True))
    assert len(list(walk(TreeText(copied).tree(tree)))) > len(list(walk(TreeText(text).tree(tree))))


def levels(level: list[Shape]) -> list[list[Shape]]:
    return [level, *(deeper for each in level if len(each) == 3 for deeper in levels(each[2]))]


@given(places())
def test_a_part_becomes_a_tree_that_is_used_where_it_was(place: tuple[str, str, str]) -> None:
    text, tree, path = place
    if path == "root":
        return
    part = shape(TreeText(text).node(tree, path))
    there = TreeText(apply(text, Extract(tree=tree, path=path, name="NewPart")))
    assert [shape(each) for each in there.tree("NewPart").children] == [part]
    known = tree if tree in there.trees else "Main"
    assert there.node(known, path).value("ID") == "NewPart"


@given(places())
def test_a_tree_has_its_new_name_wherever_it_is_used(place: tuple[str, str, str]) -> None:
    text, tree, _ = place
    changed = apply(text, RenameTree(tree=tree, name="NewName"))
    assert len(changed.splitlines()) == len(text.splitlines())
    there = TreeText(changed)
    assert "NewName" in there.trees and tree not in there.trees
    uses = [
        each.value("ID")
        for one in there.trees.values()
        for _, each in walk(one)
        if kind_of(each) == "SubTree"
    ]
    assert tree not in uses and there.root.value("main_tree_to_execute") != tree


@given(places())
def test_what_changes_nothing_gives_the_very_text(place: tuple[str, str, str]) -> None:
    text, tree, path = place
    at, *_ = reversed([0, *steps(path)])
    parent = path.rpartition(".")[0] or "root"
    if path != "root":
        assert apply(text, Move(tree=tree, path=path, to_tree=tree, parent=parent, index=at)) == text
    assert apply(text, RenameTree(tree=tree, name=tree)) == text


FILE = """\ufeff<?xml version="1.0"?>\r
<root BTCPP_format="4">\r
  <BehaviorTree ID='Main'>\r
    <!-- first -->\r
    <Sequence>\r
      <A x='1' _odd="&#65;"   y = "2"/> <!-- of A -->\r
      <!-- of B -->\r
      <B/>\r
    </Sequence>\r
  </BehaviorTree>\r
</root>\r
"""


def changed(operation: Any, text: str = FILE) -> tuple[list[str], list[str]]:
    """The lines that an operation takes away, and those that it brings."""
    before, after = text.split("\r\n"), apply(text, operation).split("\r\n")
    return [line for line in before if line not in after], [line for line in after if line not in before]


def test_a_file_keeps_its_line_ends_its_quotes_and_its_comments() -> None:
    new = Insert(tree="Main", parent="root", index=1, node=NEW)
    assert changed(new) == ([], ['      <Sleep msec="5"/>'])
    assert apply(FILE, new).index("of A") < apply(FILE, new).index("Sleep") < apply(FILE, new).index("of B")
    _, there = changed(SetAttribute(tree="Main", path="0", name="x", value="it's"))
    assert there == ['      <A x=\'it&apos;s\' _odd="&#65;"   y = "2"/> <!-- of A -->']
    assert changed(Remove(tree="Main", path="1")) == (["      <B/>"], [])


def test_another_kind_keeps_name_what_editors_wrote_and_the_nodes_below() -> None:
    node = NewNode(kind="Repeat", attributes={"y": "3"})
    assert changed(Replace(tree="Main", path="0", node=node))[1] == [
        '      <Repeat _odd="&#65;"   y = "3"/> <!-- of A -->'
    ]
    assert changed(Replace(tree="Main", path="root", node=NewNode(kind="Fallback")))[1] == [
        "    <Fallback>",
        "    </Fallback>",
    ]


def test_a_tree_more_names_the_main_one() -> None:
    there = TreeText(apply(FILE, AddTree(name="Two")))
    assert list(there.trees) == ["Main", "Two"] and there.root.value("main_tree_to_execute") == "Main"
    text = apply(apply(FILE, AddTree(name="Two")), Insert(tree="Two", parent="", index=0, node=NEW))
    assert '    <Sleep msec="5"/>\r\n  </BehaviorTree>' in text
    moved = apply(text, Move(tree="Main", path="0", to_tree="Two", parent="root", index=0))
    assert "x='1'" in moved.partition('ID="Two"')[2]
    assert list(TreeText(apply(moved, RemoveTree(tree="Two"))).trees) == ["Main"]


def test_parameters_are_written_into_the_model() -> None:
    text = apply(FILE, SetParameter(tree="Main", name="slot", about="where <it> lies"))
    assert '      <input_port name="slot">where &lt;it&gt; lies</input_port>\r\n    </SubTree>' in text
    typed = apply(text, SetParameter(tree="Main", name="slot", type="int"))
    assert '<input_port name="slot" type="int">where' in typed
    assert apply(typed, SetParameter(tree="Main", name="slot")) == text
    assert "input_port" not in apply(text, RemoveParameter(tree="Main", name="slot"))


@pytest.mark.parametrize(
    ("operation", "words"),
    [
        (Remove(tree="Mian", path="0"), "no tree 'Mian' in this file; there are Main"),
        (Remove(tree="Main", path="7"), "has no node '7'"),
        (Remove(tree="Main", path="0.x"), "is no path of a node"),
        (Insert(tree="Main", parent="", index=0, node=NEW), "has a node at its top"),
        (Insert(tree="Main", parent="root", index=9, node=NEW), "there are 2"),
        (Insert(tree="Main", parent="root", index=0, node=NewNode(kind="a><b")), "must be letters"),
        (SetAttribute(tree="Main", path="0", name='x="" y', value="1"), "must be letters"),
        (SetAttribute(tree="Main", path="0", name="x", value="\0"), "XML has none"),
        (Unwrap(tree="Main", path="0"), "nothing in this node"),
        (Unwrap(tree="Main", path="root"), "one node at its top"),
        (RemoveTree(tree="Main"), "the main one"),
        (RenameTree(tree="Main", name="Sequence"), "a kind of node"),
        (AddTree(name="a b"), "cannot be the name of a tree"),
        (Extract(tree="Main", path="root", name="Two"), "the whole tree"),
        (RemoveParameter(tree="Main", name="x"), "has no parameter"),
    ],
)  # fmt: skip
def test_what_cannot_be_done_is_refused_in_words(operation: Any, words: str) -> None:
    with pytest.raises(EditError, match=re.escape(words)):
        apply(FILE, operation)


@pytest.mark.parametrize("text", ["", "<root>", "<tree/>", "no XML", "<!DOCTYPE r><root/>"])
def test_what_cannot_be_read_is_refused_in_words(text: str) -> None:
    with pytest.raises(EditError):
        apply(text, AddTree(name="Two"))
