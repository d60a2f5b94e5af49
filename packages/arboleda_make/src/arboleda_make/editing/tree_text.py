"""Text of a file of trees, of which trees and nodes are found by name and path."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import count

from arboleda.drivers import among, quoted
from arboleda_trees.bt_xml.findings import XmlFault
from arboleda_trees.bt_xml.markup import LARGEST, Element, parse
from arboleda_trees.bt_xml.nodes import OTHER_SPELLINGS, Category
from arboleda_trees.bt_xml.reading import MODELS, ROOT, TAGS, TREE

from .errors import EditError

BOM = "\ufeff"
TOP = "root"  # the path of a tree's own node; below it `0`, `0.1`, ...


@dataclass(frozen=True)
class TreeText:
    """Text that is XML, with its elements; `content` are its bytes without a mark of their order."""

    text: str

    def __post_init__(self) -> None:
        if len(self.text.encode()) > LARGEST:
            raise EditError(f"the file has more than {LARGEST} bytes; make a file of its own of a part")
        if self.root.name != ROOT:
            raise EditError(f"the outermost tag is <{self.root.name}>; it must be <{ROOT}>")

    @cached_property
    def content(self) -> bytes:
        return self.text.removeprefix(BOM).encode()

    @cached_property
    def root(self) -> Element:
        try:
            return parse(self.content).root
        except XmlFault as fault:
            place = f"line {fault.mark.line}, column {fault.mark.column}"
            raise EditError(f"{place}: {fault.sentence}") from None

    @cached_property
    def trees(self) -> dict[str, Element]:
        """The trees by name, one without a name as the check calls it; of two of one name the first."""
        found: dict[str, Element] = {}
        numbers = count()
        for each in self.root.all(TREE):
            found.setdefault(each.value("ID") or f"{TREE}_{next(numbers)}", each)
        return found

    def tree(self, name: str) -> Element:
        """The tree of that name; raises EditError if there is none."""
        if name not in self.trees:
            raise EditError(f"there is no tree {quoted(name)} in this file; {among(name, self.trees)}")
        return self.trees[name]

    def node(self, tree: str, path: str) -> Element:
        """The node at a path; raises EditError if there is none."""
        return self.family(tree, path)[-1]

    def family(self, tree: str, path: str) -> tuple[Element, ...]:
        """The tree, all nodes above a path, and the node there; raises EditError if there is none."""
        found = [self.tree(tree)]
        for step in [0, *steps(path)]:
            if not 0 <= step < len(found[-1].children):
                raise EditError(f"the tree {quoted(tree)} has no node {quoted(path)}")
            found.append(found[-1].children[step])
        return tuple(found)

    def model(self, tree: str) -> Element | None:
        """The model of a tree, which says its parameters; None if the file has none."""
        models = (each for group in self.root.all(MODELS) for each in group.all(Category.SUBTREE.value))
        return next((each for each in models if each.value("ID") == tree), None)


def steps(path: str) -> list[int]:
    """The positions that lead from a tree's own node to one below it; raises EditError for no path."""
    parts = [] if path == TOP else path.split(".")
    if not all(each.isascii() and each.isdigit() and len(each) < 6 for each in parts):
        raise EditError(f'{quoted(path)} is no path of a node; it is "{TOP}", or like "0.2"')
    return [int(each) for each in parts]


def path_of(steps: list[int]) -> str:
    """The path with these positions."""
    return ".".join(map(str, steps)) or TOP


def kind_of(element: Element) -> str:
    """The kind of a node, however it is written; "" for one without a name."""
    if is_subtree(element):
        return Category.SUBTREE.value
    kind = (element.value("ID") or "") if element.name in TAGS else element.name
    return OTHER_SPELLINGS.get(kind, kind)


def is_subtree(element: Element) -> bool:
    return OTHER_SPELLINGS.get(element.name, element.name) == Category.SUBTREE.value


def walk(tree: Element) -> Iterator[tuple[str, Element]]:
    """The nodes below a tree with their paths, in the order of the file."""
    waiting: list[tuple[list[int], Element]] = [([], each) for each in tree.children[:1]]
    while waiting:
        steps, element = waiting.pop()
        yield path_of(steps), element
        below = [([*steps, number], child) for number, child in enumerate(element.children)]
        waiting += reversed(below)
