"""Names of faults for people: the same on buttons, in lists, in tables and in what a proof says."""

from __future__ import annotations

OPERATOR = "operator_"  # begins the kinds that are verbs of an operator
TITLES = {
    "reboot": "Reboot its board",
    "brown_out": "Take its power away",
    "mute": "Its board is not heard",
    "board_stall": "Freeze its board",
    "driver_alarm": "Alarm of its motor driver",
    "lost_steps": "An axis slips",
    "gives_up": "It gives up its work",
    "refuses": "It refuses its orders",
    "never_ends": "It never ends",
    "ends_late": "It takes longer",
    "only_says_done": "It says done and does nothing",
    "answers_twice": "It answers twice",
    "forgets": "It restarts and forgets",
    "opened_device": "Somebody takes out what it holds",
    "stale_fact": "It goes on telling an old value",
    "lying_fact": "It tells a false value",
    "stuck_bit": "A field of its telemetry stands still",
    "lying_telemetry": "Its telemetry is false",
    "garbled_telemetry": "Its telemetry cannot be read",
    "no_grip": "Grip beside the part",
    "stuck_effector": "The effector sticks",
    "no_part": "No part there to take",
    "lost_part": "Lose the part",
    "opened_effector": "Somebody opens its effector",
    "piece_false": "Its piece sensor is wrong",
    "piece_flicker": "Its piece sensor flickers",
    "loss": "Messages are lost",
    "duplicate": "Messages come twice",
    "reorder": "Messages overtake each other",
    "delay": "Slow its link down",
    "partition": "Cut its link",
    "hop_delay": "Plant and bridge hear each other late",
    "hop_reorder": "Messages of the plant lose their order",
    "hop_partition": "Cut the link of plant and bridge",
    "broker_restart": "The broker restarts",
    "lost_queue": "A queue of the broker overflows",
    "bridge_restart": "The bridge restarts",
    "bridge_stall": "The bridge hangs",
    "plant_stall": "The plant hangs",
    "plant_freeze": "The plant is frozen",
    "plant_crash": "The plant dies and starts again",
    "second_orchestrator": "A superseded plant commands it",
    "foreign_beat": "Another plant beats",
    "foreign_command": "Another node commands it",
    "double_submit": "A task is asked for twice",
    "bad_task": "A task is asked for in wrong words",
    "flood_of_tasks": "Too many tasks are asked for",
    "foreign_garbage": "A stranger sends nonsense",
    "foreign_report": "A stranger reports in its name",
    "foreign_repeat": "Its report comes once more",
    "foreign_stray": "A stranger sends to nobody",
    "foreign_retained": "An old command is kept for it",
    "foreign_old": "A stranger repeats an old command",
    "foreign_halt": "A stranger halts it",
    "crash_in_step": "The plant dies within a step",
    "power_cut": "The plant loses power",
    "full_disk": "The plant's disk is full",
    "slow_disk": "The plant's disk is slow",
    "leader_killed": "The leader dies",
    "leader_frozen": "The leader is frozen",
    "store_cut": "It is cut off from the store",
    "store_away": "The store is away",
    "store_slow": "The store is slow",
    "store_answer_lost": "An answer of the store is lost",
    "clock_drift": "Its clock drifts",
    "clock_step": "Somebody sets its clock",
    "handover": "A planned change of leaders",
    "teach": "Somebody teaches it by hand",
}
FORMS = {
    ("gives_up", "atasco"): "It jams",
    ("gives_up", "sin_aire"): "It has no air",
    ("refuses", "ocupado"): "It refuses its orders",
    ("refuses", "condicion"): "It refuses its orders: a condition",
}
"""Names of forms whose words are those of boards."""


def title(kind: str, word: str = "") -> str:
    """The name of a kind of fault, or of its form with this word."""
    if kind.startswith(OPERATOR):
        return f"Operator: {kind.removeprefix(OPERATOR)}"
    return FORMS.get((kind, word)) or TITLES[kind]
