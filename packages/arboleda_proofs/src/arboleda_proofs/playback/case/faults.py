"""The troubles of a record's devices as faults of the simulator; times are those of the plant's clock."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

from arboleda.model.messages import Reason
from arboleda.model.plant_model import PlantModel
from arboleda_proofs.playback.cause import TOGETHER_S, Cause, Evidence
from arboleda_proofs.playback.incident import Incident
from arboleda_proofs.playback.troubles import ALARM, BOOT, BRIDGE, Trouble
from arboleda_proofs.simulator.faults import KINDS, Fault

LATE_S = 60.0  # a board that booted without losing its link: its last will comes too late to matter
AROUND_S = 0.3  # a fault begins so long before the event that it makes fail
LOST_S = 0.4  # around a lost command: no longer, as boards without a beat stop by themselves
SHOWN_S = 0.2  # until a part's loss shows
RECONNECT_S = 0.5  # from a broker that is back to the first words of its clients


def faults_of(troubles: Iterable[Trouble], model: PlantModel) -> list[Fault]:
    """The troubles of this plant's robots as faults."""
    boards = {robot.name: robot.mqtt for robot in model.robots.values()}
    mine = [trouble for trouble in troubles if trouble.robot in boards]
    found = [_fault(trouble, mine, boards[trouble.robot]) for trouble in mine]
    return _possible(found, model)


def faults_behind(incident: Incident, cause: Cause, model: PlantModel) -> list[Fault]:
    """The cause of a failed task as faults, if the reports do not show it as a trouble."""
    make, robot = OF_CAUSE.get(cause.kind), model.robots.get(cause.robot or "")
    if cause.kind == "plant_away":
        return [stall(at, seconds) for at, seconds in incident.absences]
    if cause.kind == "foreign" and robot is not None:
        return _possible(_stopped_by_another(incident, robot.name), model)
    if make is None or robot is None or incident.failed_at is None:
        return []
    return _possible(make(incident.evidence, robot.mqtt), model)


def _stopped_by_another(incident: Incident, robot: str) -> list[Fault]:
    """The command of somebody else as a fault: only its stop can have made the task fail, whatever it was."""
    word = "stop" if incident.failure and incident.failure.reason is Reason.STOPPED else "halt"
    times = [at for at, name in incident.foreign if name == robot] or [incident.failed_at or 0.0]
    return [Fault(kind="second_orchestrator", target=robot, at=times[-1], word=word)]


def stall(until: float, seconds: float) -> Fault:
    """A fault in which the plant did nothing for so long."""
    return Fault(kind="plant_stall", target="plant", at=until - seconds, seconds=seconds)


def _possible(faults: Iterable[Fault], model: PlantModel) -> list[Fault]:
    there = (fault for fault in faults if KINDS[fault.kind].objection(fault, model) is None)
    return list(dict.fromkeys(there))


def _fault(trouble: Trouble, others: Iterable[Trouble], board: str) -> Fault:
    at, seconds = trouble.at, trouble.seconds
    if trouble.kind == BRIDGE:
        return Fault(kind="bridge_restart", target="bridge", at=at, seconds=seconds)
    if trouble.kind == ALARM:
        return Fault(kind="driver_alarm", target=board, at=at, seconds=seconds)
    together = [each for each in others if _broke_together(each, trouble)]
    if len({each.robot for each in together}) > 1:
        lost_at = min(each.lost_at or each.at for each in together)
        lasting = max(0.0, min(each.ends for each in together) - lost_at - RECONNECT_S)
        return Fault(kind="broker_restart", target="broker", at=lost_at, seconds=lasting)
    if trouble.kind == BOOT or trouble.cut:
        lost_s = (trouble.lost_at or trouble.ends) - at if trouble.cut else LATE_S
        return Fault(kind="brown_out", target=board, at=at, seconds=seconds, amount=lost_s)
    return Fault(kind="mute", target=board, at=at, seconds=seconds)


def _broke_together(one: Trouble, other: Trouble) -> bool:
    if not (one.cut and other.cut):
        return False
    return abs((one.lost_at or 0.0) - (other.lost_at or 0.0)) < TOGETHER_S


def _while_switching(kind: str) -> Callable[[Evidence, str], Iterator[Fault]]:
    """Maker of a fault that lasts from before the last switching of the robot until the task had failed."""

    def make(evidence: Evidence, board: str) -> Iterator[Fault]:
        switches = [each.at for each in evidence.sent if each.robot == evidence.robot and each.switch]
        yield _until_failed(kind, board, evidence, max(switches, default=evidence.failed_at))

    return make


def _while_ordered(kind: str, *, word: bool = False) -> Callable[[Evidence, str], Iterator[Fault]]:
    """Maker of a fault from before the robot's last command on, with the word of the evidence if wanted."""

    def make(evidence: Evidence, board: str) -> Iterator[Fault]:
        sent = evidence.last
        began = sent.at if sent is not None else evidence.failed_at
        yield _until_failed(kind, board, evidence, began, evidence.word if word else "")

    return make


def _until_failed(kind: str, board: str, evidence: Evidence, at: float, word: str = "") -> Fault:
    began = at - AROUND_S
    return Fault(kind=kind, target=board, at=began, seconds=evidence.failed_at + AROUND_S - began, word=word)


def _just_before(*kinds: str) -> Callable[[Evidence, str], Iterator[Fault]]:
    def make(evidence: Evidence, board: str) -> Iterator[Fault]:
        for kind in kinds:
            yield Fault(kind=kind, target=board, at=evidence.failed_at - SHOWN_S)

    return make


def _unheard(evidence: Evidence, board: str) -> Iterator[Fault]:
    sent = evidence.last
    at = sent.at if sent is not None else evidence.failed_at
    yield Fault(kind="lost_queue", target=board, at=at - LOST_S / 2, seconds=LOST_S)


def _either(*makes: Callable[[Evidence, str], Iterator[Fault]]) -> Callable[[Evidence, str], Iterator[Fault]]:
    """Maker of faults for robots of several kinds; those impossible for this robot are left out later."""
    return lambda evidence, board: (fault for make in makes for fault in make(evidence, board))


OF_CAUSE: dict[str, Callable[[Evidence, str], Iterator[Fault]]] = {
    "no_part": _while_switching("no_part"),
    "not_gripped": _while_switching("no_grip"),
    "part_lost": _just_before("lost_part"),
    "opened": _just_before("opened_effector", "opened_device"),
    "unheard": _unheard,
    "switch": _either(_while_switching("stuck_effector"), _while_ordered("never_ends")),
    "unended": _while_ordered("never_ends"),
    "off_target": _while_ordered("only_says_done"),
    "gave_up": _while_ordered("gives_up", word=True),
    "refused": _while_ordered("refuses", word=True),
}
