"""Edits of whole trees, their names and their parameters."""

from __future__ import annotations

from html import escape

from arboleda.drivers import quoted
from arboleda_trees.bt_xml import names
from arboleda_trees.bt_xml.markup import Element
from arboleda_trees.bt_xml.nodes import Category, PortDirection, built_in
from arboleda_trees.bt_xml.reading import MODELS, TAGS, TREE

from . import attributes, layout
from .attributes import written
from .errors import EditError
from .layout import Splice, spliced
from .operations import (
    AddTree,
    Extract,
    RemoveParameter,
    RemoveTree,
    RenameTree,
    SetParameter,
)
from .tree_text import TOP, TreeText, is_subtree, walk

MAIN = "main_tree_to_execute"
PARAMETER = PortDirection.IN.value


def add(text: TreeText, edit: AddTree, node: bytes = b"") -> bytes:
    """The content with one tree more; the one that was the only one is then the main one by its name."""
    _check_free(text, edit.name)
    content = _with_main(text)
    root = TreeText(content.decode()).root
    last = max((number for number, each in enumerate(root.children, 1) if each.name == TREE), default=0)
    fragment = f'<{TREE} ID="{written(edit.name)}"/>'.encode()
    if node:
        line, unit = layout.line_end(content), layout.unit(content, root)
        head = fragment.removesuffix(b"/>") + b">"
        fragment = head + line + unit + layout.indented(node, b"", unit) + line + f"</{TREE}>".encode()
    return spliced(content, [layout.insertion(content, root, root, last, fragment)])


def remove(text: TreeText, edit: RemoveTree) -> bytes:
    element = text.tree(edit.tree)
    if len(text.trees) == 1 or text.root.value(MAIN) == edit.tree:
        raise EditError(f"the tree {quoted(edit.tree)} is the main one of this file; it stays")
    gone = [element, *([model] if (model := text.model(edit.tree)) is not None else [])]
    return spliced(text.content, [layout.removal(text.content, each.span) for each in gone])


def rename(text: TreeText, edit: RenameTree) -> bytes:
    tree = text.tree(edit.tree)
    if edit.name == edit.tree:
        return text.content
    _check_free(text, edit.name)
    uses = [each for tree in text.trees.values() for _, each in walk(tree) if is_subtree(each)]
    named = [tree, *(each for each in uses if each.value("ID") == edit.tree)]
    named += [model] if (model := text.model(edit.tree)) is not None else []
    splices = [each for element in named for each in _change(text, element, "ID", edit.name)]
    if text.root.value(MAIN) == edit.tree:
        splices += _change(text, text.root, MAIN, edit.name)
    return spliced(text.content, splices)


def extract(text: TreeText, edit: Extract) -> bytes:
    if edit.path == TOP:
        raise EditError(f"this is the whole tree {quoted(edit.tree)}; take a part of it")
    fragment = layout.taken(text.content, text.node(edit.tree, edit.path).span)
    there = TreeText(add(text, AddTree(name=edit.name), fragment).decode())
    name = edit.tree if edit.tree in there.trees else next(iter(there.trees))
    span = there.node(name, edit.path).span
    subtree = attributes.tag(Category.SUBTREE.value, {"ID": edit.name, "_autoremap": "true"})
    return spliced(there.content, [Splice(span.start, span.end, subtree)])


def set_parameter(text: TreeText, edit: SetParameter) -> bytes:
    text.tree(edit.tree)
    attributes.check_name(edit.name, "the name of a parameter")
    if (why := names.of_port(edit.name)) is not None:
        raise EditError(f"{quoted(edit.name)} cannot be the name of a parameter: {why}")
    text = _with_model(text, edit.tree)
    model = text.model(edit.tree)
    assert model is not None  # it has just been written
    there = _parameter(model, edit.name)
    if there is not None:
        return spliced(text.content, _change(text, there, "type", edit.type or None))
    fields = {"name": edit.name, **({"type": edit.type} if edit.type else {})}
    tag = attributes.tag(PARAMETER, fields)
    if edit.about:
        about = escape(edit.about, quote=False)
        tag = tag.removesuffix(b"/>") + f">{about}</{PARAMETER}>".encode()
    last = max((at for at, each in enumerate(model.children, 1) if each.name == PARAMETER), default=0)
    return spliced(text.content, [layout.insertion(text.content, text.root, model, last, tag)])


def remove_parameter(text: TreeText, edit: RemoveParameter) -> bytes:
    text.tree(edit.tree)
    model = text.model(edit.tree)
    there = None if model is None else _parameter(model, edit.name)
    if there is None:
        raise EditError(f"the tree {quoted(edit.tree)} has no parameter {quoted(edit.name)}")
    return spliced(text.content, [layout.removal(text.content, there.span)])


def _parameter(model: Element, name: str) -> Element | None:
    return next((each for each in model.all(PARAMETER) if each.value("name") == name), None)


def _with_model(text: TreeText, tree: str) -> TreeText:
    """The text with a model of a tree, which its parameters stand in."""
    if text.model(tree) is not None:
        return text
    content = text.content
    if not text.root.all(MODELS):
        end = len(text.root.children)
        group = f"<{MODELS}/>".encode()
        content = spliced(content, [layout.insertion(content, text.root, text.root, end, group)])
    there = TreeText(content.decode())
    models = there.root.all(MODELS)[0]
    tag = attributes.tag(Category.SUBTREE.value, {"ID": tree})
    splice = layout.insertion(content, there.root, models, len(models.children), tag)
    return TreeText(spliced(content, [splice]).decode())


def _with_main(text: TreeText) -> bytes:
    """The content with the name of its main tree, which was clear while it was the only one."""
    trees = text.root.all(TREE)
    if text.root.value(MAIN) is not None or len(trees) != 1:
        return text.content
    name = trees[0].value("ID") or "Main"
    splices = _change(text, text.root, MAIN, name) + _change(text, trees[0], "ID", name)
    return spliced(text.content, splices)


def _check_free(text: TreeText, name: str) -> None:
    """Raises EditError if no tree can get this name."""
    if (why := names.of_node(name)) is not None:
        raise EditError(f"{quoted(name)} cannot be the name of a tree: {why}")
    if built_in(name) is not None or name in TAGS:
        raise EditError(f"{name} is a kind of node; give the tree another name")
    if name in text.trees:
        raise EditError(f"there is a tree {quoted(name)} already; give this one another name")


def _change(text: TreeText, element: Element, name: str, value: str | None) -> list[Splice]:
    return attributes.change(text.content, element, name, value)
