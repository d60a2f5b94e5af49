"""State of the arm by a frame: its modes by number, and the words for what keeps it from moving."""

from __future__ import annotations

from enum import IntEnum

from arboleda.drivers import MotionState

from .rtde import Frame


class Mode(IntEnum):
    """The controller's `robot_mode`."""

    NO_CONTROLLER = -1
    DISCONNECTED = 0
    CONFIRM_SAFETY = 1
    BOOTING = 2
    POWER_OFF = 3
    POWER_ON = 4
    IDLE = 5
    BACKDRIVE = 6
    RUNNING = 7
    UPDATING = 8


class Runtime(IntEnum):
    """The controller's `runtime_state`: what its program does."""

    STOPPING = 0
    STOPPED = 1
    PLAYING = 2
    PAUSING = 3
    PAUSED = 4
    RESUMING = 5


NORMAL, REDUCED, PROTECTIVE_STOP = 1, 2, 3
SAFETY = {
    PROTECTIVE_STOP: "protective_stop",
    4: "safety_recovery",
    5: "safeguard_stop",
    6: "system_stop_button",
    7: "robot_stop_button",
    8: "safety_violation",
    9: "safety_fault",
    10: "joint_id_unconfirmed",
    11: "safety_undefined",
    12: "automatic_safeguard_stop",
    13: "enabling_device_released",
}
"""The word for each `safety_status` in which the arm cannot move."""
MODES: dict[int, str] = {
    Mode.NO_CONTROLLER: "no_controller",
    Mode.DISCONNECTED: "disconnected",
    Mode.CONFIRM_SAFETY: "safety_unconfirmed",
    Mode.BOOTING: "starting",
    Mode.POWER_OFF: "power_off",
    Mode.POWER_ON: "starting",
    Mode.IDLE: "brakes_not_released",
    Mode.BACKDRIVE: "moved_by_hand",
    Mode.UPDATING: "updating",
}
"""The word for each `robot_mode` in which the arm cannot move."""


def safety_word(frame: Frame) -> str:
    """The word for the safety state that keeps the arm from moving; "" for none."""
    if frame.safety in (NORMAL, REDUCED):
        return ""
    return SAFETY.get(frame.safety, f"safety_status {frame.safety}")


def mode_word(frame: Frame) -> str:
    """The word for the mode of an arm that is not ready."""
    return MODES.get(frame.mode, f"robot_mode {frame.mode}")


def hindrance(frame: Frame) -> str:
    """The word for what keeps the arm from moving; "" for nothing."""
    if word := safety_word(frame):
        return word
    return "" if frame.mode == Mode.RUNNING else mode_word(frame)


def motion_state(frame: Frame) -> MotionState:
    """The state of the arm, whoever moves it."""
    if safety_word(frame):
        return MotionState.FAULT
    if frame.mode == Mode.BACKDRIVE:
        return MotionState.MOVING
    if frame.mode != Mode.RUNNING:
        return MotionState.NOT_HOMED
    # A paused program may be resumed at any moment by whoever paused it.
    return MotionState.STOPPED if frame.runtime == Runtime.STOPPED else MotionState.MOVING
