"""Edits of the nodes of one tree."""

from __future__ import annotations

from arboleda.drivers import quoted
from arboleda_trees.bt_xml import names
from arboleda_trees.bt_xml.markup import Element
from arboleda_trees.bt_xml.reading import TAGS

from . import attributes, layout
from .errors import EditError
from .layout import Splice, spliced
from .operations import Insert, Move, NewNode, Remove, Replace, SetAttribute, Unwrap, Wrap
from .tree_text import TOP, TreeText, is_subtree, path_of, steps


def insert(text: TreeText, edit: Insert) -> bytes:
    return _put(text, edit.tree, edit.parent, edit.index, _written(edit.node))


def move(text: TreeText, edit: Move) -> bytes:
    element = text.node(edit.tree, edit.path)
    place = [*steps(edit.parent), edit.index] if edit.parent else []
    path = steps(edit.path)
    if edit.tree == edit.to_tree and not edit.stays:
        if place[: len(path)] == path and len(place) > len(path):
            raise EditError("a node cannot go into itself")
        if place[:-1] == path[:-1] and place and path and place[-1] - path[-1] in (0, 1):
            return text.content
    fragment = layout.taken(text.content, element.span)
    content = _put(text, edit.to_tree, edit.parent, edit.index, fragment)
    if edit.stays:
        return content
    there = TreeText(content.decode())
    gone = there.node(edit.tree, path_of(_after(path, place) if edit.tree == edit.to_tree else path))
    return spliced(content, [layout.removal(content, gone.span)])


def remove(text: TreeText, edit: Remove) -> bytes:
    return spliced(text.content, [layout.removal(text.content, text.node(edit.tree, edit.path).span)])


def replace(text: TreeText, edit: Replace) -> bytes:
    element = text.node(edit.tree, edit.path)
    kept = {name for name in element.attributes if name == "name" or name.startswith("_")}
    gone = [name for name in element.attributes if name not in kept and name not in edit.node.attributes]
    splices = attributes.rename(element, edit.node.kind)
    for name in gone:
        splices += attributes.change(text.content, element, name, None)
    content = spliced(text.content, splices)
    for name, value in edit.node.attributes.items():
        renamed = TreeText(content.decode()).node(edit.tree, edit.path)
        content = spliced(content, attributes.change(content, renamed, name, value))
    return content


def wrap(text: TreeText, edit: Wrap) -> bytes:
    span = text.node(edit.tree, edit.path).span
    margin = layout.margin(text.content, span.start)
    head = _written(edit.node).removesuffix(b"/>") + b">"
    closing = f"</{edit.node.kind}>".encode()
    fragment = layout.taken(text.content, span)
    if margin is None:
        return spliced(text.content, [Splice(span.start, span.end, head + fragment + closing)])
    line, inner = layout.line_end(text.content), margin + layout.unit(text.content, text.root)
    block = line + inner + layout.indented(fragment, b"", inner) + line + margin
    return spliced(text.content, [Splice(span.start, span.end, head + block + closing)])


def unwrap(text: TreeText, edit: Unwrap) -> bytes:
    element = text.node(edit.tree, edit.path)
    if not element.children:
        raise EditError("there is nothing in this node that could take its place; remove it")
    if edit.path == TOP and len(element.children) > 1:
        raise EditError("a tree has one node at its top, and there are several in this one")
    span, content = element.span, text.content
    inner = content[span.head : span.tail].strip()
    old = layout.margin(content, element.children[0].span.start)
    new = layout.margin(content, span.start)
    block = inner if old is None or new is None else layout.indented(inner, old, new)
    return spliced(content, [Splice(span.start, span.end, block)])


def set_attribute(text: TreeText, edit: SetAttribute) -> bytes:
    element = text.node(edit.tree, edit.path)
    is_kind = edit.name == "ID" and (element.name in TAGS or is_subtree(element))
    if edit.value is None and is_kind:
        raise EditError(f"{element.name} needs its ID")
    if edit.name == "name" and (why := names.of_one_node(edit.value or "")) is not None:
        raise EditError(f"a node cannot be called {quoted(edit.value)}: {why}")
    return spliced(text.content, attributes.change(text.content, element, edit.name, edit.value))


def _put(text: TreeText, tree: str, parent: str, index: int, fragment: bytes) -> bytes:
    """The content with a fragment as a child of a node; at the top of a tree that has none for ""."""
    holder: Element = text.node(tree, parent) if parent else text.tree(tree)
    if not parent and holder.children:
        raise EditError(f"the tree {quoted(tree)} has a node at its top; put this one around it, or into it")
    if not 0 <= index <= len(holder.children):
        raise EditError(f"a node cannot be number {index} here: there are {len(holder.children)}")
    return spliced(text.content, [layout.insertion(text.content, text.root, holder, index, fragment)])


def _after(path: list[int], place: list[int]) -> list[int]:
    """The path of a node once another was put at a place."""
    level = len(place) - 1
    if place and len(path) > level and path[:level] == place[:level] and place[level] <= path[level]:
        return [*path[:level], path[level] + 1, *path[level + 1 :]]
    return path


def _written(node: NewNode) -> bytes:
    return attributes.tag(node.kind, node.attributes)
