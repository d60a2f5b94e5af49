"""Dashboard of a virtual controller: a line is told, and a line is answered."""

from __future__ import annotations

from arboleda_drivers.ur.arm_state import NORMAL, Mode, Runtime

from .arm import Arm

QUERIES = ("robotmode", "safetystatus", "programState", "running", "is in remote control", "PolyscopeVersion")
EARLY = "Cannot unlock protective stop until 5s after occurrence"
SAFETY = {NORMAL: "NORMAL", 3: "PROTECTIVE_STOP", 5: "SAFEGUARD_STOP", 7: "ROBOT_EMERGENCY" + "_STOP"}
PROGRAM = {Runtime.PLAYING: "PLAYING", Runtime.PAUSED: "PAUSED"}


class Dashboard:
    """Answers lines, and does to the arm what they say."""

    def __init__(self, arm: Arm) -> None:
        self._arm = arm

    def reply(self, now: float, line: str, runtime: Runtime, *, is_local: bool) -> str:
        """The answer to a line; what ends or pauses a program is the controller's."""
        arm = self._arm
        if is_local and line not in QUERIES:
            return f"Failed to execute: {line}"
        if line.startswith("popup"):
            return "showing popup"
        if line in ("close popup", "close safety popup"):
            arm.close_popup()
            return line.replace("close", "closing")
        if line == "power on":
            arm.power(now)
            return "Powering on"
        if line == "power off":
            arm.mode = Mode.POWER_OFF
            return "Powering off"
        if line == "brake release":
            arm.release(now)
            return "Brake releasing"
        if line == "unlock protective stop":
            return "Protective stop releasing" if arm.unlock(now) else EARLY
        if line == "play":
            arm.goes_on = runtime == Runtime.PAUSED
            return "Starting program" if arm.goes_on else "Failed to execute: play"
        return self._state(line, runtime, is_local=is_local)

    def _state(self, line: str, runtime: Runtime, *, is_local: bool) -> str:
        program = PROGRAM.get(runtime, "STOPPED")
        replies = {
            "robotmode": f"Robotmode: {self._arm.mode.name}",
            "safetystatus": f"Safetystatus: {SAFETY[self._arm.safety]}",
            "safetymode": f"Safetymode: {SAFETY[self._arm.safety]}",
            "programState": f"{program} arboleda.script",
            "running": f"Program running: {str(program == 'PLAYING').lower()}",
            "is in remote control": str(not is_local).lower(),
            "PolyscopeVersion": "URSoftware 5.12.0.0 (virtual)",
            "get robot model": "UR10",
            "get serial number": "20260000000",
            "stop": "Stopped",
            "quit": "Disconnected",
        }
        return replies.get(line, f"could not understand: '{line[:40]}'")
