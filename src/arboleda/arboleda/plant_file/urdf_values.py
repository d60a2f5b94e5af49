"""Numbers, origins and shapes of a URDF; for an impossible one, a problem is kept with its line."""

from __future__ import annotations

import math
import re

from .document import choice, shown
from .problems import Problems
from .xml_marks import Tag

NUMBER = re.compile(r"[-+]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][-+]?[0-9]+)?", re.ASCII)
NAME = re.compile(r"[A-Za-z0-9_./-]{1,64}", re.ASCII)
NAME_RULE = "at most 64 letters, digits, dots, /, - and _"
FARTHEST_M = 100.0
SIZES = {"box": (("size", 3),), "cylinder": (("radius", 1), ("length", 1)), "sphere": (("radius", 1),)}


def name_of(problems: Problems, tag: Tag) -> str | None:
    """The name of a link or a joint."""
    name = tag.attributes.get("name")
    if name is None:
        problems.keep(tag.mark, f"this {tag.name} has no name")
    elif not NAME.fullmatch(name):
        problems.keep(tag.mark, f"the name {shown(name)} of a {tag.name} must be {NAME_RULE}")
    else:
        return name
    return None


def number(problems: Problems, tag: Tag, key: str, default: float | None = None) -> float | None:
    """One number of a tag; None, with the problem kept, if there is none and no default."""
    if key not in tag.attributes and default is not None:
        return default
    values = numbers(problems, tag, key, 1)
    return values[0] if values else None


def numbers(problems: Problems, tag: Tag, key: str, count: int) -> tuple[float, ...] | None:
    """This many numbers of a tag, with spaces between them."""
    text = tag.attributes.get(key)
    if text is None:
        problems.keep(tag.mark, f"{key} of <{tag.name}> is missing")
        return None
    words = text.split()
    if len(words) != count or not all(NUMBER.fullmatch(word) for word in words):
        wanted = "a number" if count == 1 else f"{count} numbers with spaces between them"
        problems.keep(tag.mark, f"{key} of <{tag.name}> must be {wanted}, is {shown(text)}")
        return None
    values = tuple(float(word) for word in words)
    if not all(map(math.isfinite, values)):
        problems.keep(tag.mark, f"{key} of <{tag.name}> must be finite, is {shown(text)}")
        return None
    return values


def check_origin(problems: Problems, tag: Tag) -> None:
    """Check the place of a joint or a shape, if it gives one."""
    origin = tag.first("origin")
    if origin is None:
        return
    for key in ("xyz", "rpy"):
        values = numbers(problems, origin, key, 3) if key in origin.attributes else None
        if values and key == "xyz" and max(map(abs, values)) > FARTHEST_M:
            problems.keep(origin.mark, f"xyz of <origin> is in metres; more than {FARTHEST_M:g} m is too far")


def check_shapes(problems: Problems, link: Tag) -> None:
    """Check the shapes by which a link is drawn, and those that it hits with."""
    for part in (*link.all("visual"), *link.all("collision")):
        check_origin(problems, part)
        geometry = part.first("geometry")
        if geometry is None or len(geometry.children) != 1:
            problems.keep((geometry or part).mark, f"a <{part.name}> has one shape in its <geometry>")
        else:
            _check_shape(problems, geometry.children[0])
        for material in part.all("material"):
            check_color(problems, material)


def check_color(problems: Problems, material: Tag) -> None:
    """Check the colour of a material, if it gives one."""
    color = material.first("color")
    shares = numbers(problems, color, "rgba", 4) if color else None
    if color and shares and not all(0 <= share <= 1 for share in shares):
        problems.keep(color.mark, "rgba of <color> must be 4 numbers from 0 to 1")


def _check_shape(problems: Problems, shape: Tag) -> None:
    if shape.name == "mesh":
        if "filename" not in shape.attributes:
            problems.keep(shape.mark, "filename of <mesh> is missing")
        return
    if shape.name not in SIZES:
        problems.keep(shape.mark, f"a shape is a {choice([*SIZES, 'mesh'])}, not {shown(shape.name)}")
        return
    for key, count in SIZES[shape.name]:
        sizes = numbers(problems, shape, key, count)
        if sizes and not all(0 <= value <= FARTHEST_M for value in sizes):
            rule = f"must be 0 to {FARTHEST_M:g} m"
            problems.keep(shape.mark, f"{key} of <{shape.name}> {rule}, is {shown(shape.attributes[key])}")
