"""Faults of a virtual arm of servos, with a sentence on each."""

from __future__ import annotations

FAULTS = {
    "overload": "whenever the arm moves the second servo stops with an overload alarm, which stays",
    "overheating": "the third servo is at 80 degrees, and stops with an alarm, which stays",
    "low_voltage": "the supply is at 4.5 V, and every servo has an alarm of its voltage",
    "torque_off": "the torque of all servos is switched off",
    "mute_servo": "the third servo does not answer",
    "mute": "no servo answers",
    "power_cycle": "the servos have no power while this is on; then they boot, without torque",
    "unplugged": "the cable to the bus adapter is pulled while this is on",
    "broken_frames": "every third answer has a wrong check sum",
    "torn": "every third answer lacks its last two bytes",
    "old_position": "the third servo repeats the position at which it was as this began",
    "noise": "stray bytes come before every answer",
    "echo": "the line echoes what is written",
    "late": "answers come 80 ms late",
    "wrong_id": "every third answer carries the id of another servo",
    "no_goal": "the second servo takes no goal",
    "another_master": "whenever the arm moves another program gives the first servo a goal",
    "pushed": "somebody holds the first joint 15 degrees away from where it wants to be",
    "stall": "moves stand still half way",
    "deaf": "goals that come while the arm moves are not taken",
    "slow": "the arm moves at a tenth of its speed",
    "gripper_stuck": "the gripper does not move",
    "part": "the gripper closes on a part half way, which is no fault",
    "wrong_mode": "the second servo is set to turn without end",
}
