"""Model of the plant's own: a URDF or YAML file beside the plant file, with the keys of `model:`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from arboleda.kinds.joints import Description, Joint
from arboleda.model.errors import ConfigError
from arboleda.model.outside import plain
from arboleda.wire.units import to_wire

from . import urdf_file, user_file, xml_marks, yaml_marks, yaml_model
from .document import Document, Place, choice, shown
from .own_urdf import drawing, lifts
from .robot_models import PINION_MM, TO_SI, ArmModel, millimetres
from .shapes import DAY_S, MAPPING, POSITIVE, SPEED, ModelShape, OffsetShape
from .urdf_axis import Axis
from .urdf_file import Chain
from .yaml_marks import clipped

ENDINGS = (".urdf", ".yaml", ".yml")
LONGEST = 500  # characters of a path as a sentence shows it
MOST_JOINTS = 12  # as many as one MQTT message of 512 bytes has room for
FARTHEST = 99_999.0  # deg on the wire
FASTEST = 1e6  # steps/s, one per microsecond of a board's clock
FULL_SPEED_S = 0.5  # time of a joint to its full speed, where none is declared
STEP_DEG, STEP_MM = 0.01, 0.1  # a motor step, where none is declared
LONGEST_RAMP = 250_000  # steps to full speed; a virtual board counts each of them
SLOW = {"deg": 30, "mm": 50}  # deg/s and mm/s, as a person might write them
LEAST_STEP = 0.001  # deg or mm: MQTT has four decimals


def is_own(value: Any) -> bool:
    """True if `model:` names a file, and not a model that comes with Arboleda."""
    if isinstance(value, dict):
        return True
    return isinstance(value, str) and ("/" in value or value.endswith((*ENDINGS, ".xacro")))


def own_model(document: Document, place: Place) -> ArmModel | None:
    """The arm of that file; None, with its problems kept, if something is wrong with it."""
    shape = _shape(document, place)
    if shape is None:
        return None
    spot = (*place, "file") if isinstance(document.value(place), dict) else place
    mount, tool = (_offset(document, (*place, key)) for key in ("mount", "tool"))
    raw = _content(document, spot, shape.file)
    if raw is None or not _fits(document, place, shape):
        return None
    try:
        chain = _chain(shape, raw, _path(document, shape.file))
    except urdf_file.WrongLink as error:
        document.problem((*place, error.key), error.sentence)
        return None
    except ConfigError as error:
        document.keep_those_of(error)
        return None
    joints = _joints(document, place, spot, chain)
    if joints is None:
        return None
    _find_meshes(chain, _path(document, shape.file).parent)
    urdf = drawing(chain, mount, tool)
    lifting = [replace(joint, up=up) for joint, up in zip(joints, lifts(urdf, joints), strict=True)]
    name = clipped(Path(shape.file).name)
    notes = tuple(f"{name}: {note}" for note in (*chain.notes, *_assumed(document, place, chain)))
    return ArmModel(name=name, joints=tuple(lifting), description=Description(urdf=urdf, notes=notes))


def _shape(document: Document, place: Place) -> ModelShape | None:
    value = document.value(place)
    return document.read(ModelShape, place) if isinstance(value, dict) else ModelShape(file=value)


def _offset(document: Document, place: Place) -> OffsetShape | None:
    return document.read(OffsetShape, place) if document.has(place) else None


def _path(document: Document, file: str) -> Path:
    return (document.folder or Path()) / file


def _content(document: Document, place: Place, file: str) -> bytes | None:
    """The content of the file; None, with the problem kept, if it cannot be read."""
    if file.endswith(".xacro"):
        made = file.removesuffix(".xacro")
        made = made if made.endswith(".urdf") else f"{made}.urdf"
        type_this = f"xacro {plain(file)} > {plain(made)}"
        document.problem(place, f"xacro is not read here; type `{type_this}` and name that")
    elif not file.endswith(ENDINGS):
        document.problem(place, f"must be a file that ends in {choice(ENDINGS)}, is {shown(file)}")
    elif document.folder is None:
        document.problem(place, "this plant file lies in no folder, so no model can lie beside it")
    else:
        largest = xml_marks.LARGEST if file.endswith(".urdf") else yaml_marks.LARGEST
        try:
            path = _path(document, file)
            content = document.files[path] = user_file.read_bytes(path, largest)
            return content
        except ConfigError as error:
            document.problem(place, plain(str(error), LONGEST))
    return None


def _fits(document: Document, place: Place, shape: ModelShape) -> bool:
    """True if `model:` names links only for a URDF, which has links."""
    of_urdf = [key for key in ("base_link", "tip_link") if getattr(shape, key) is not None]
    foreign = of_urdf if not shape.file.endswith(".urdf") else []
    for key in foreign:
        document.problem((*place, key), "only a URDF has links; delete it")
    return not foreign


def _chain(shape: ModelShape, raw: bytes, path: Path) -> Chain:
    if path.suffix == ".urdf":
        return urdf_file.read(plain(str(path), LONGEST), raw, base=shape.base_link, tip=shape.tip_link)
    return yaml_model.read(plain(str(path), LONGEST), raw)


def _find_meshes(chain: Chain, folder: Path) -> None:
    """Replace the paths of meshes, which are relative to the file, by absolute ones."""
    for mesh in chain.robot.iter("mesh"):
        name = mesh.get("filename", "")
        if "://" not in name:
            mesh.set("filename", (folder / name).absolute().as_uri())


def _joints(document: Document, place: Place, spot: Place, chain: Chain) -> tuple[Joint, ...] | None:
    """The joints with all that a motor needs; None, with the problems kept, if one cannot be driven.

    `place` is that of `model:`. `speeds:` beside it may have speeds that the file of the model lacks.
    """
    if len(chain.axes) > MOST_JOINTS:
        most = f"at most {MOST_JOINTS}; one MQTT message has room for no more"
        document.problem(spot, f"has {len(chain.axes)} joints that move, {most}")
        return None
    axes = [_with_speed(document, place, number, axis) for number, axis in enumerate(chain.axes, start=1)]
    _refuse_open_speeds(document, place, spot, axes)
    joints = [
        _joint(document, place, number, axis, axis.speed)
        for number, axis in enumerate(axes, start=1)
        if axis.speed
    ]
    for key, unit in (("accelerations", "_s2"), ("steps", "")):
        allowed = [f"q{number}_{_unit(axis)}{unit}" for number, axis in enumerate(chain.axes, start=1)]
        written = document.read_plain(MAPPING, (*place, key)) if document.has((*place, key)) else None
        for name in written or {}:
            if name not in allowed:
                document.unknown((*place, key, name), allowed)
    good = [_is_drivable(document, spot, joint) for joint in joints]
    return tuple(joints) if all(good) and len(joints) == len(axes) else None


def _with_speed(document: Document, place: Place, number: int, axis: Axis) -> Axis:
    """The axis with its speed, which the plant file may have where the file of the model has none."""
    if axis.speed is not None:
        return axis
    speed = document.read_plain(SPEED, _speed_place(place, number, axis))
    return replace(axis, speed=TO_SI[_unit(axis)](speed) if speed else None)


def _speed_place(place: Place, number: int, axis: Axis) -> Place:
    return (*place[:-1], "speeds", f"q{number}_{_unit(axis)}_s")


def _refuse_open_speeds(document: Document, place: Place, spot: Place, axes: Sequence[Axis]) -> None:
    """Keep a problem, with what to write, for joints whose speed neither file has."""
    places = {axis.name: _speed_place(place, number, axis) for number, axis in enumerate(axes, 1)}
    open_ = [axis for axis in axes if axis.speed is None and not document.has(places[axis.name])]
    if open_:
        joints = " and ".join(axis.name for axis in open_)
        written = ", ".join(f"{places[axis.name][-1]}: {SLOW[_unit(axis)]}" for axis in open_)
        document.problem(
            spot,
            f"no velocity for {joints}; "
            f"write speeds: {{{written}}} beside model, but with the numbers of its maker",
        )


def _joint(document: Document, place: Place, number: int, axis: Axis, speed: float) -> Joint:
    """The joint by the plant file, else by the file of its model, else by defaults."""
    si = TO_SI[_unit(axis)]
    acceleration = document.read_plain(POSITIVE, (*place, "accelerations", f"q{number}_{_unit(axis)}_s2"))
    step = document.read_plain(POSITIVE, (*place, "steps", f"q{number}_{_unit(axis)}"))
    slides = axis.type == "prismatic"
    return Joint(
        name=axis.name,
        lower=axis.lower,
        upper=axis.upper,
        speed=speed,
        acceleration=si(acceleration) if acceleration else axis.acceleration or speed / FULL_SPEED_S,
        step=si(step) if step else axis.step or si(STEP_MM if slides else STEP_DEG),
        pinion_radius_m=(axis.pinion_radius_m or millimetres(PINION_MM)) if slides else None,
    )


def _unit(axis: Axis) -> str:
    return "mm" if axis.type == "prismatic" else "deg"


def _is_drivable(document: Document, place: Place, joint: Joint) -> bool:
    """True if a board can count, report and drive the joint."""
    least = TO_SI["mm" if joint.unit == "m" else "deg"](LEAST_STEP)
    wide = joint.upper - joint.lower
    if max(abs(to_wire(joint, end)) for end in (joint.lower, joint.upper)) > FARTHEST:
        why = f"has limits beyond {FARTHEST:g} deg on MQTT"
    elif not least <= joint.step <= wide:
        why = f"has a motor step that is not from {LEAST_STEP:g} deg or mm to all of its way"
    elif joint.speed / joint.step > FASTEST:
        steps = joint.speed / joint.step
        why = f"takes {steps:.3g} motor steps a second; at most {FASTEST:g}, so give it larger ones"
    elif not joint.travel_s(wide) <= DAY_S:
        why = "needs more than a day for its whole way"
    elif min(joint.speed**2 / joint.acceleration, wide) / 2 / joint.step > LONGEST_RAMP:
        why = f"needs more than {LONGEST_RAMP} motor steps to its full speed; give it larger ones"
    else:
        return True
    document.problem(place, f"the joint {joint.name} {why}")
    return False


def _assumed(document: Document, place: Place, chain: Chain) -> Sequence[str]:
    """The notes on accelerations and motor steps that are assumed, as no file has them."""
    open_: dict[str, list[str]] = {"accelerations": [], "steps": []}
    for number, axis in enumerate(chain.axes, start=1):
        own_values = {"accelerations": axis.acceleration, "steps": axis.step}
        for key, value in own_values.items():
            own = f"q{number}_{_unit(axis)}" + ("_s2" if key == "accelerations" else "")
            if value is None and not document.has((*place, key, own)):
                open_[key].append(f"q{number}")
    taken = {
        "accelerations": f"accelerations to full speed in {FULL_SPEED_S:g} s",
        "steps": f"motor steps of {STEP_DEG:g} deg or {STEP_MM:g} mm",
    }
    return [
        f'{what} are assumed for {", ".join(open_[key])}; "{key}" says otherwise'
        for key, what in taken.items()
        if open_[key]
    ]
