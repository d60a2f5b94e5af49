"""Files -> forest: both forms of writing a node, includes, models, and the spellings of version 3."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from itertools import count

from arboleda.drivers import quoted
from arboleda.model.errors import ConfigError
from arboleda.recipes.of_files import Mark, Place

from . import names, nodes
from .findings import Findings, XmlFault
from .forest import Forest, Metadata, Node, Tree
from .markup import Element, Markup, parse
from .nodes import Category, Kind, Port, PortDirection
from .values import plain_type

MOST_FILES = 50
ROOT, TREE, MODELS, INCLUDE = "root", "BehaviorTree", "TreeNodesModel", "include"
METADATA, ONE_OF_METADATA = "MetadataFields", "Metadata"
TAGS = {each.value: each for each in Category}
FORMATS = ("3", "4")
Fetch = Callable[[str, str, str], tuple[str, bytes]]
"""Reads the file of an `include`: its name and its content; raises MissingInclude or ConfigError.

The arguments are the name of the including file, the path, and the ROS package of the path ("" for none).
"""


class MissingInclude(ConfigError):
    """Error: a file belongs to another machine, or to a package that is not installed; it is not missed."""


def nothing_beside(file: str, path: str, package: str) -> tuple[str, bytes]:
    """Raises ConfigError: text without a folder cannot include a file."""
    raise ConfigError((f"{path}: there are no files beside this one",))


def read(file: str, content: bytes, findings: Findings, fetch: Fetch = nothing_beside) -> Forest:
    """The trees of a file and of all files that it includes; faults are kept in the findings."""
    reader = _ForestReader(findings, fetch)
    reader.read(file, content)
    main = reader.main
    if main is None and len(reader.trees) == 1:
        main = next(iter(reader.trees))
    return Forest(
        trees=reader.trees,
        models=reader.models,
        own=frozenset(reader.own),
        metadata=reader.metadata,
        main=main,
        is_whole=reader.is_whole,
    )


@dataclass
class _ForestReader:
    findings: Findings
    fetch: Fetch
    trees: dict[str, Tree] = field(default_factory=dict)
    models: dict[str, Kind] = field(default_factory=dict)
    own: set[str] = field(default_factory=set)
    metadata: dict[str, tuple[Metadata, ...]] = field(default_factory=dict)
    main: str | None = None
    is_whole: bool = True
    _files: set[str] = field(default_factory=set)
    _numbers: Iterator[int] = field(default_factory=count)

    def read(self, file: str, content: bytes) -> None:
        is_first = not self._files
        self._files.add(file)
        try:
            markup = parse(content)
        except XmlFault as fault:
            self.findings.mistake(Place(file, fault.mark), fault.sentence)
            self.is_whole = False
            return
        page = _Page(file, self.findings, is_old=markup.root.value("BTCPP_format") != "4")
        page.look_at(markup)
        for element in markup.root.children:
            if element.name == INCLUDE:
                self._include(page, element)
        for element in markup.root.children:
            if element.name == MODELS:
                declared = page.models(element)
                self.models |= declared
                self.own |= {
                    each.name for each in declared.values() if nodes.is_own(each, is_old=page.is_old)
                }
                self.metadata |= page.metadata(element)
        for element in markup.root.children:
            if element.name == TREE:
                self._add(page, element, alone=len(markup.root.all(TREE)) == 1)
        if is_first:
            self._choose_main(page, markup.root)

    def _choose_main(self, page: _Page, root: Element) -> None:
        named = root.attributes.get("main_tree_to_execute")
        if named is not None and named.value not in self.trees and self.is_whole:
            trees = ", ".join(self.trees) or "none"
            page.mistake(named.mark, f"there is no tree {quoted(named.value)}; there are {trees}")
        elif named is not None:
            self.main = named.value

    def _add(self, page: _Page, element: Element, *, alone: bool) -> None:
        name = element.value("ID")
        if name is None and not alone:
            page.mistake(element.mark, f'each of several trees needs a name: <{TREE} ID="...">')
        name = name or f"{TREE}_{next(self._numbers)}"
        if (why := names.of_node(name)) is not None:
            sentence = f"newer editors refuse {quoted(name)} as the name of a tree: {why}"
            page.warning(element.mark, sentence, kind="name-of-a-tree")
        if nodes.built_in(name) is not None:
            self._refuse_name(page, element, name)
        if len(element.children) != 1:
            page.mistake(element.mark, f"the tree {name} has {len(element.children)} nodes below it, not 1")
        if name in self.trees:
            first = self.trees[name].place
            page.mistake(element.mark, f"there are two trees {name}; the other is at {first}")
        elif element.children and (root := page.node(element.children[0])) is not None:
            own = {key: each for key, each in element.attributes.items() if key != "ID"}
            self.trees[name] = Tree(name=name, root=root, own=own, place=page.place(element.mark))

    def _refuse_name(self, page: _Page, element: Element, name: str) -> None:
        """Keep a finding for a tree that has the name of a built-in kind of node."""
        if name in nodes.OF_LIBRARY and not (page.is_old and name in nodes.SINCE_VERSION_4):
            page.mistake(element.mark, f"a tree cannot be called {name}: a kind of node has this name")
        elif name in nodes.BUILT_IN:
            where = "BehaviorTree.CPP 4" if name in nodes.OF_LIBRARY else "Nav2 or MoveIt"
            sentence = f"{where} has a kind of node {name}, too: with it a tree cannot be called so"
            page.warning(element.mark, sentence, kind="name-of-a-tree-that-a-node-has")

    def _include(self, page: _Page, element: Element) -> None:
        path, package = element.attributes.get("path"), element.attributes.get("ros_pkg")
        if path is None:
            page.mistake(element.mark, 'which file? <include path="..."/>')
            return
        try:
            file, content = self.fetch(page.file, path.value, "" if package is None else package.value)
        except MissingInclude as error:
            page.warning(path.mark, str(error))
            self.is_whole = False
            return
        except ConfigError as error:
            page.mistake(path.mark, str(error))
            self.is_whole = False
            return
        if file not in self._files and len(self._files) < MOST_FILES:
            self.read(file, content)
        elif file not in self._files:
            page.mistake(element.mark, f"more than {MOST_FILES} files are included")
            self.is_whole = False


@dataclass(frozen=True)
class _Page:
    """File that is being read; `is_old`: the file does not declare the format of version 4."""

    file: str
    findings: Findings
    is_old: bool

    def place(self, mark: Mark) -> Place:
        return Place(self.file, mark)

    def mistake(self, mark: Mark, sentence: str) -> None:
        self.findings.mistake(self.place(mark), sentence)

    def warning(self, mark: Mark, sentence: str, kind: str = "") -> None:
        self.findings.warning(self.place(mark), sentence, kind)

    def look_at(self, markup: Markup) -> None:
        """Keep the findings of the file as a whole: its root, its format, and unknown tags."""
        root, format = markup.root, markup.root.attributes.get("BTCPP_format")
        for mark, letter in markup.raw:
            entity = {"&": "&amp;", "<": "&lt;"}[letter]
            sentence = f"a raw {letter} is no XML, though BehaviorTree.CPP takes it; write {entity}"
            self.warning(mark, sentence, kind="raw-letter")
        if root.name != ROOT:
            self.mistake(root.mark, f"the outermost tag is <{root.name}>; it must be <{ROOT}>")
        if format is not None and format.value not in FORMATS:
            self.mistake(format.mark, f"BTCPP_format is {quoted(format.value)}; 3 and 4 are known")
        for element in root.children:
            if element.name not in (TREE, MODELS, INCLUDE):
                sentence = f"<{element.name}> means nothing here; {TREE}, {MODELS}, {INCLUDE} do"
                self.warning(element.mark, sentence, kind="tag")
        for second in root.all(MODELS)[1:]:
            self.mistake(second.mark, f"a second <{MODELS}>; one is allowed")
        if root.name == ROOT and not root.children:
            self.warning(root.mark, "there is no tree in this file")

    def node(self, element: Element) -> Node | None:
        """A node with all nodes below it; None, with a finding, for one without a name."""
        tag, kind = TAGS.get(element.name), element.name
        if tag is not None:
            kind = element.value("ID") or ""
            if not kind:
                self.mistake(element.mark, f'which? <{element.name} ID="...">')
                return None
        elif nodes.OTHER_SPELLINGS.get(kind) == Category.SUBTREE.value:
            tag = Category.SUBTREE
        below = tuple(node for child in element.children if (node := self.node(child)) is not None)
        return self._one(element, tag, kind, below)

    def _one(self, element: Element, tag: Category | None, kind: str, below: tuple[Node, ...]) -> Node | None:
        is_subtree = tag is Category.SUBTREE
        if is_subtree and not element.value("ID"):
            self.mistake(element.mark, f'which tree? <SubTree ID="...">, instead of <{element.name}>')
            return None
        attributes = element.attributes
        own = {name: each for name, each in attributes.items() if name.startswith("_")}
        if is_subtree:
            own["ID"] = attributes["ID"]
        ports = {
            name: each for name, each in attributes.items() if name not in own and name not in ("ID", "name")
        }
        return Node(
            kind=Category.SUBTREE.value if is_subtree else nodes.OTHER_SPELLINGS.get(kind, kind),
            tag=tag,
            name=element.value("name") or "",
            ports=ports,
            own=own,
            children=below,
            place=self.place(element.mark),
        )

    def models(self, element: Element) -> dict[str, Kind]:
        """The kinds that a file declares, by name."""
        kinds: dict[str, Kind] = {}
        for child in element.children:
            name = child.value("ID")
            if child.name not in TAGS:
                sentence = f"<{child.name}> is no kind of node; there are {', '.join(TAGS)}"
                self.warning(child.mark, sentence, kind="tag-of-a-model")
            elif not name:
                self.mistake(child.mark, f'which? <{child.name} ID="...">')
            else:
                if (why := names.of_node(name)) is not None:
                    sentence = f"newer editors refuse {quoted(name)} as the name of a node: {why}"
                    self.warning(child.mark, sentence, kind="name-of-a-node")
                kinds[name] = self._kind(child, name, TAGS[child.name])
        return kinds

    def metadata(self, element: Element) -> dict[str, tuple[Metadata, ...]]:
        """The metadata of the models of trees, by tree."""
        trees = element.all(Category.SUBTREE.value)
        return {name: tuple(self._metadata(each)) for each in trees if (name := each.value("ID"))}

    def _metadata(self, model: Element) -> Iterator[Metadata]:
        for each in (each for fields in model.all(METADATA) for each in fields.all(ONE_OF_METADATA)):
            for key, attribute in each.attributes.items():
                yield Metadata(key=key, text=attribute.value, place=self.place(attribute.mark))

    def _kind(self, element: Element, name: str, category: Category) -> Kind:
        fewest, most = nodes.children(category)
        ports = [
            port
            for direction in PortDirection
            for each in element.all(direction.value)
            if (port := self._port(each, direction))
        ]
        return Kind(name=name, category=category, ports=nodes.by_name(ports), fewest=fewest, most=most)

    def _port(self, element: Element, direction: PortDirection) -> Port | None:
        name = element.value("name")
        if name is None:
            self.mistake(element.mark, f'which? <{direction.value} name="...">')
            return None
        if not name.startswith("_") and (why := names.of_port(name)) is not None:
            sentence = f"newer editors refuse {quoted(name)} as the name of a port: {why}"
            self.warning(element.mark, sentence, kind="name-of-a-port")
        default = element.value("default")
        return Port(
            name=name,
            type=plain_type(element.value("type")),
            direction=direction,
            default=default or None,
            is_needed=not default,
        )
