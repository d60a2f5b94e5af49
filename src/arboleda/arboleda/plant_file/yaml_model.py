"""YAML of an arm, in the form of the files of arboleda_description -> the arm's chain of joints."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Literal
from xml.etree.ElementTree import Element, SubElement

from pydantic import Field

from arboleda.kinds.joints import Joint

from .document import Document, Place, shown
from .own_urdf import ROOT, in_words
from .robot_models import ArmFile, JointFile, described_joint
from .urdf_axis import Axis
from .urdf_file import NO_ENDS, Chain
from .urdf_values import NAME, NAME_RULE

ALONG = (0.0, 0.0, 0.0)
UPWARDS = (0.0, 0.0, 1.0)


class OwnArmFile(ArmFile):
    """The form of an arm of arboleda_description, without keys that only its drawing and readers need."""

    model: str = ""
    kind: Literal["arm"] = "arm"
    sources: dict[str, str] = Field(default_factory=dict)


def read(name: str, raw: bytes) -> Chain:
    """The chain that `joints` describes; ConfigError with every problem."""
    document = Document(name, raw)
    shape = document.read(OwnArmFile)
    places: list[Place] = [("joints", index) for index in range(len(shape.joints))] if shape else []
    joints = [described_joint(document, place) for place in places]
    files = [document.read(JointFile, place) for place in places]
    _check_names(document, places, joints)
    if shape and not places:
        document.problem(("joints",), "is empty; an arm has one joint at least")
    document.finish()
    whole = [(file, joint) for file, joint in zip(files, joints, strict=True) if file and joint]
    return Chain(
        robot=_robot(whole),
        base=ROOT,
        tip=_link(len(whole)),
        axes=tuple(_axis(file, joint) for file, joint in whole),
        notes=tuple(_notes(whole)),
    )


def _check_names(document: Document, places: Sequence[Place], joints: Sequence[Joint | None]) -> None:
    names: set[str] = set()
    for place, joint in zip(places, joints, strict=True):
        if joint is None:
            continue
        if not NAME.fullmatch(joint.name):
            document.problem((*place, "name"), f"must be {NAME_RULE}, is {shown(joint.name)}")
        elif joint.name in names:
            document.problem((*place, "name"), f"two joints have the name {joint.name}")
        names.add(joint.name)


def _axis(file: JointFile, joint: Joint) -> Axis:
    return Axis(
        name=joint.name,
        type=file.type,
        lower=joint.lower,
        upper=joint.upper,
        speed=joint.speed,
        acceleration=joint.acceleration,
        step=joint.step,
        pinion_radius_m=joint.pinion_radius_m,
    )


def _notes(whole: Sequence[tuple[JointFile, Joint]]) -> Iterator[str]:
    yield from (NO_ENDS.format(joint.name) for file, joint in whole if file.type == "continuous")
    if not any(any(file.origin_xyz_m) for file, _ in whole):
        yield "no joint has origin_xyz_m, so all of them are drawn in one point"


def _robot(whole: Sequence[tuple[JointFile, Joint]]) -> Element:
    """Links in a row, without shapes."""
    robot = Element("robot", {"name": "arm"})
    SubElement(robot, "link", {"name": ROOT})
    for number, (file, joint) in enumerate(whole, start=1):
        parent = _link(number - 1) if number > 1 else ROOT
        SubElement(robot, "link", {"name": _link(number)})
        made = SubElement(robot, "joint", {"name": joint.name, "type": file.type})
        SubElement(made, "parent", {"link": parent})
        SubElement(made, "child", {"link": _link(number)})
        origin = {"xyz": in_words(file.origin_xyz_m or ALONG), "rpy": in_words(file.origin_rpy_rad or ALONG)}
        SubElement(made, "origin", origin)
        SubElement(made, "axis", {"xyz": in_words(file.axis or UPWARDS)})
        SubElement(made, "limit", {"effort": f"{file.effort_n_m or file.effort_n:g}"})
    return robot


def _link(number: int) -> str:
    return f"link{number}"
