"""A URDF that a person wrote -> one chain of joints from the arm's foot to its tool, in SI units."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from xml.etree.ElementTree import Element, SubElement

from arboleda.model.errors import ConfigError

from .document import choice, nearest, shown
from .problems import Problems
from .urdf_axis import MOVING, Axis, axis
from .urdf_values import check_color, check_origin, check_shapes, name_of
from .xml_marks import Tag, XmlFault, parse
from .yaml_marks import clipped

JOINT_TYPES = (*MOVING, "fixed")
NO_ENDS = "the joint {} has no ends; it is taken as -360 deg to 360 deg"
MOST_LINKS = 300
REFUSED = {
    "planar": "it moves in a plane, and here every joint has one motor; write two prismatic joints",
    "floating": "nothing holds it, and here every joint has one motor; make it fixed",
}


@dataclass(frozen=True, kw_only=True)
class Chain:
    """The joints from foot to tool, their drawing, and the assumptions made."""

    robot: Element
    base: str
    tip: str
    axes: tuple[Axis, ...]
    notes: tuple[str, ...] = ()


class WrongLink(Exception):
    """The plant file names a wrong link under `key`; `sentence` says why."""

    def __init__(self, key: str, sentence: str) -> None:
        super().__init__(sentence)
        self.key = key
        self.sentence = sentence


def read(name: str, raw: bytes, *, base: str | None = None, tip: str | None = None) -> Chain:
    """The chain from the link `base` to the link `tip`, each of which is looked for where it is None.

    ConfigError with every problem of the file; WrongLink if a given link cannot begin or end the chain.
    """
    try:
        top = parse(raw)
    except XmlFault as fault:
        raise ConfigError((f"{name}:{fault.mark.line}:{fault.mark.column}: {fault.sentence}",)) from None
    return _ChainReader(name, top).chain(base, tip)


class _ChainReader:
    def __init__(self, name: str, top: Tag) -> None:
        self._problems = Problems(name)
        self._top = top
        self._links: dict[str, Tag] = {}
        self._joints: dict[str, Tag] = {}
        self._above: dict[str, Tag] = {}  # by link: the joint that carries it

    def _say(self, tag: Tag, sentence: str) -> None:
        self._problems.keep(tag.mark, sentence)

    def chain(self, base: str | None, tip: str | None) -> Chain:
        self._check_form()
        self._problems.finish()
        foot = self._foot(base)
        self._problems.finish()
        end = self._tool(foot, tip)
        self._problems.finish()
        joints = self._joints_between(foot, end)
        axes = [axis(self._problems, joint) for joint in joints if joint.attributes["type"] in MOVING]
        if not axes:
            self._say(self._top, f"no joint moves between {foot} and {end}; an arm has one at least")
        self._problems.finish()
        whole = tuple(each for each in axes if each)
        return Chain(
            robot=self._pruned(foot, {each.name for each in whole}),
            base=foot,
            tip=end,
            axes=whole,
            notes=tuple(self._notes(foot, joints)),
        )

    def _check_form(self) -> None:
        """Check every tag by itself, and that joints lead from links to links."""
        if any(map(_needs_xacro, _all(self._top))):
            made = "this is xacro; type `xacro FILE.urdf.xacro > FILE.urdf` and name what that makes"
            self._say(self._top, made)
            self._problems.finish()
        if self._top.name != "robot":
            self._say(self._top, f"a URDF begins with <robot>, not <{clipped(self._top.name)}>")
            self._problems.finish()
        for name, tags in (("link", self._links), ("joint", self._joints)):
            for tag in self._top.all(name):
                self._note(tag, tags)
        if len(self._links) > MOST_LINKS:
            self._say(self._top, f"it has {len(self._links)} links; at most {MOST_LINKS} are taken")
            self._problems.finish()
        for link in self._links.values():
            check_shapes(self._problems, link)
        for material in self._top.all("material"):
            check_color(self._problems, material)
        for name, joint in self._joints.items():
            self._check_joint(name, joint)
        self._problems.finish()
        self._check_circles()

    def _note(self, tag: Tag, tags: dict[str, Tag]) -> None:
        name = name_of(self._problems, tag)
        if name is None:
            return
        if name in tags:
            first = f"the first is on line {tags[name].mark.line}"
            self._say(tag, f"the {tag.name} {name} is there twice; {first}")
        tags.setdefault(name, tag)

    def _check_joint(self, name: str, joint: Tag) -> None:
        kind = joint.attributes.get("type", "")
        if kind in REFUSED:
            self._say(joint, f"the joint {name} is {kind}: {REFUSED[kind]}")
        elif kind not in JOINT_TYPES:
            rule = f"type of the joint {name} must be {choice(JOINT_TYPES)}"
            self._say(joint, f"{rule}, is {shown(kind)}{nearest(kind, JOINT_TYPES)}")
        check_origin(self._problems, joint)
        for end in ("parent", "child"):
            tag = joint.first(end)
            link = (tag.attributes.get("link", "") if tag else "") or ""
            if tag is None or link not in self._links:
                what = f"the {end} of the joint {name} must be a link of this file"
                self._say(tag or joint, f"{what}, is {shown(link)}{nearest(link, self._links)}")
            elif end == "child" and link in self._above:
                other = self._above[link].attributes["name"]
                self._say(tag, f"the link {link} hangs on two joints, {other} and {name}")
            elif end == "child":
                self._above[link] = joint

    def _check_circles(self) -> None:
        """Check that joints lead from each link up to a first link; a circle is named once."""
        for link in self._links:
            above, visited = link, {link}
            while above in self._above:
                above = _end_of(self._above[above], "parent")
                if above in visited:
                    self._say(self._above[above], f"the joints go round in a circle, from {above} back to it")
                    return
                visited.add(above)

    def _foot(self, wanted: str | None) -> str:
        """The link that stands on the floor."""
        if wanted is not None:
            self._check_link("base_link", wanted)
            return wanted
        first = [name for name in self._links if name not in self._above]
        if not first:
            self._say(self._top, "it has no links")
            return ""
        if len(first) > 1:
            links = " and ".join(first[:4])
            self._say(
                self._links[first[1]], f"it begins with several links, {links}; say which with base_link"
            )
        return first[0]

    def _tool(self, foot: str, wanted: str | None) -> str:
        """The link at the arm's end, behind its last joint that moves: `tool0`, or the only end."""
        below = set(self._below(foot))
        if wanted is not None:
            self._check_link("tip_link", wanted)
            if wanted not in below:
                raise WrongLink("tip_link", f"the link {wanted} does not hang on {foot}")
            return wanted
        last = self._last(foot)
        if not last:
            self._say(self._top, "no joint moves; an arm has a revolute, continuous or prismatic one")
        elif len(last) > 1:
            ends = f"it has two ends that move, {last[0]} and {last[1]}"
            choice_of_tool = f"{ends}; say with tip_link which one is the arm's tool"
            self._say(self._above[last[1]], f"{choice_of_tool}{self._hand(foot, last)}")
        else:
            return self._end(last[0])
        return ""

    def _last(self, foot: str) -> list[str]:
        """The links behind the last motors, and links that follow them, as the second finger of a hand."""
        above = {link: self._above[link] for link in self._below(foot) if link != foot and self._moves(link)}
        driven = {link for link, joint in above.items() if joint.first("mimic") is None}
        last = [link for link in above if link in driven and set(self._below(link)) & driven == {link}]
        leaders = {above[link].attributes["name"] for link in last}
        return last + [link for link in above if _leader(above[link]) in leaders]

    def _hand(self, foot: str, ends: list[str]) -> str:
        """A hint that these ends may be fingers, where joints that move come before the ends part."""
        chains = [self._joints_between(foot, end) for end in ends]
        common = [joint for joint in chains[0] if all(joint in chain for chain in chains)]
        if not any(joint.attributes["type"] in MOVING for joint in common):
            return ""
        return f"; if they are fingers, write tip_link: {_end_of(common[-1], 'child')}"

    def _end(self, link: str) -> str:
        beyond = list(self._below(link))
        if "tool0" in beyond:
            return "tool0"
        ends = [each for each in beyond if not any(self._children(each))]
        if len(ends) > 1:
            text = f"the link {link} has the ends {', '.join(ends[:4])}; say with tip_link which is the tool"
            self._say(self._links[link], text)
        return ends[0]

    def _check_link(self, key: str, name: str) -> None:
        if name not in self._links:
            raise WrongLink(key, f"must be a link of the file, is {shown(name)}{nearest(name, self._links)}")

    def _joints_between(self, foot: str, end: str) -> list[Tag]:
        """The joints from foot to end."""
        joints: list[Tag] = []
        while end != foot:
            joints.insert(0, self._above[end])
            end = _end_of(joints[0], "parent")
        return joints

    def _notes(self, foot: str, chain: list[Tag]) -> Iterator[str]:
        for link in self._below(foot):
            joint = self._above[link] if link != foot else None
            if joint is None or joint.attributes["type"] not in MOVING:
                continue
            if joint not in chain:
                yield f"the joint {joint.attributes['name']} is not on the way to the tool and stays at 0"
            elif joint.attributes["type"] == "continuous":
                yield NO_ENDS.format(joint.attributes["name"])
        meshes = [link for link in self._below(foot) if _has_mesh(self._links[link])]
        if meshes:
            yield f"the twin draws a stand-in for the meshes of {', '.join(meshes)}"

    def _moves(self, link: str) -> bool:
        return link in self._above and self._above[link].attributes["type"] in MOVING

    def _children(self, link: str) -> Iterator[str]:
        return (child for child, joint in self._above.items() if _end_of(joint, "parent") == link)

    def _below(self, link: str) -> Iterator[str]:
        """The link and all links below it."""
        waiting = [link] if link in self._links else []
        visited: set[str] = set()
        while waiting:
            each = waiting.pop(0)
            if each in visited:
                continue
            visited.add(each)
            yield each
            waiting += self._children(each)

    def _pruned(self, foot: str, moving: set[str]) -> Element:
        """The links below the foot as a robot of their own; all joints are fixed but those of `moving`."""
        robot = Element("robot", {"name": self._top.attributes.get("name", "robot")})
        robot.extend(_element(material) for material in self._top.all("material"))
        for link in self._below(foot):
            if link != foot:
                joint = SubElement(robot, "joint", _own(self._above[link].attributes))
                joint.extend(_element(self._above[link]))
                if joint.get("name") not in moving:
                    _fix(joint)
            robot.append(_element(self._links[link]))
        return robot


def _all(tag: Tag) -> Iterator[Tag]:
    yield tag
    for child in tag.children:
        yield from _all(child)


def _leader(joint: Tag) -> str | None:
    """The name of the joint that a joint follows."""
    mimic = joint.first("mimic")
    return mimic.attributes.get("joint") if mimic else None


def _needs_xacro(tag: Tag) -> bool:
    """True if xacro would change the tag. A property that nothing uses changes nothing."""
    used = any("${" in value or "$(" in value for value in tag.attributes.values())
    return used or (tag.name.startswith("xacro:") and tag.name != "xacro:property")


def _end_of(joint: Tag, which: str) -> str:
    tag = joint.first(which)
    return tag.attributes["link"] if tag else ""


def _has_mesh(link: Tag) -> bool:
    return any(tag.name == "mesh" for visual in link.all("visual") for tag in _all(visual))


def _element(tag: Tag) -> Element:
    """The tag without names of other namespaces, which are not drawn."""
    element = Element(tag.name, _own(tag.attributes))
    element.extend(_element(child) for child in tag.children if ":" not in child.name)
    return element


def _fix(joint: Element) -> None:
    joint.set("type", "fixed")
    for mimic in joint.findall("mimic"):
        joint.remove(mimic)


def _own(attributes: dict[str, str]) -> dict[str, str]:
    return {name: value for name, value in attributes.items() if ":" not in name}
