"""Bugs of the laboratory in its plant file."""

from __future__ import annotations

from .lab_bug import in_plant

OF_PLANTS = (
    in_plant(
        "The mover is not shared.",
        ("shared:\n  mover: {kind: mover}\n", ""),
        ("mover:     {shared: mover}", "mover:     {kind: mover}"),
        ("      mover: {shared: mover}", "      mover: {kind: mover, name: the_mover, mqtt: mover_2}"),
    ),
    in_plant("The zone over the nest is forgotten.", ("  over_the_nest:    {poses: [lab nest]}\n", "")),
    in_plant(
        "The zone in the incubator is forgotten.",
        ("  in_the_incubator: {poses: [lab inside], free_while: {incubator: {door: open}}}\n", ""),
    ),
    in_plant(
        "The zone in the reader is forgotten.",
        ("  in_the_reader:    {poses: [lab drawer], free_while: {reader: {lid: open}}}\n", ""),
    ),
    in_plant(
        "The zones at the mover are forgotten.",
        ("  at_the_lab:       {poses: [lab deck], free_while: {mover: {at: lab}}}\n", ""),
        ("  at_the_store:     {poses: [store deck], free_while: {mover: {at: store}}}\n", ""),
    ),
    in_plant(
        "The zone of the incubator is at another target.", ("{poses: [lab inside]", "{poses: [lab bin]")
    ),
    in_plant(
        "A zone is free while the door is closed.",
        ("{incubator: {door: open}}", "{incubator: {door: closed}}"),
    ),
    in_plant(
        "A zone looks at the wrong device.",
        ("free_while: {reader: {lid: open}}", "free_while: {incubator: {door: open}}"),
    ),
    in_plant(
        "Opening the lid closes it.",
        ("open:  {effect: motion, sets: {lid: open}", "open:  {effect: motion, sets: {lid: closed}"),
    ),
    in_plant("The door is told of in the lid's words.", ("sets: {door: open}", "sets: {lid: open}")),
    in_plant("A verb has less time than it takes.", ("at_most_s: 40", "at_most_s: 4")),
    in_plant("The incubator needs an open door.", ("needs: {door: closed}", "needs: {door: open}")),
    in_plant("The pipette takes a tip where it has one.", ("needs: {tip: false}", "needs: {tip: true}")),
    in_plant("The racks are filled by nobody.", ("racks:  {supply: true}", "racks:  {}")),
    in_plant("The bin is emptied by nobody.", ("{holds: 20, output: true}", "{holds: 2}")),
    in_plant("The place of the incubator is of no device.", ("inside: {of: incubator}", "inside: {}")),
    in_plant(
        "The place of the reader is of the incubator.", ("drawer: {of: reader}", "drawer: {of: incubator}")
    ),
    in_plant("The nest is no place.", ("      nest:   {}\n", "")),
    in_plant(
        "The jaw is nobody's tool.",
        ("{kind: gripper, tool_of: loader, max_force_n: 40}", "{kind: gripper, max_force_n: 40}"),
    ),
    in_plant(
        "The claw is the tool of the wrong role.",
        ("{kind: gripper, tool_of: crane}", "{kind: gripper, tool_of: mover}"),
    ),
    in_plant(
        "Two targets have one pose.",
        ("rack_2: {loader: {deg: [-20.51, 99.61]", "rack_2: {loader: {deg: [-36.16, 97.04]"),
    ),
    in_plant(
        "A slot is missing in its group.",
        ("racks: [rack_1, rack_2, rack_3]", "racks: [rack_1, rack_2, rack_4]"),
    ),
    in_plant(
        "A target is beyond the joint.",
        ("drawer: {loader: {deg: [70, 40]", "drawer: {loader: {deg: [170, 40]"),
    ),
    in_plant(
        "An arm stands on another one.",
        (
            "doser:     {kind: arm, model: scara, base: {origin_m: [0.6, 0], yaw_deg: 45}}",
            "doser:     {kind: arm, model: scara, base: {origin_m: [-0.5, 0], yaw_deg: 45}}",
        ),
    ),
    in_plant(
        "An arm stands nowhere.",
        (
            "doser:     {kind: arm, model: scara, base: {origin_m: [0.6, 0], yaw_deg: 45}}",
            "doser:     {kind: arm, model: scara}",
        ),
    ),
    in_plant(
        "The mover leaves only with a plate in the jaw.", ("{jaw.gripped: false}", "{jaw.gripped: true}")
    ),
    in_plant("The clamp holds no part.", ("sets: {clamped: $on}, holds: part}", "sets: {clamped: $on}}")),
)

OF_WORDS = (
    in_plant(
        "Two devices have one name.",
        ("reader:    {kind: reader}", "reader:    {kind: reader, name: incubator}"),
    ),
    in_plant(
        "A need names a fact that there is not.", ("{incubator.door: closed}", "{incubator.lid: closed}")
    ),
    in_plant("A need has the wrong value.", ("{incubator.door: closed}", "{incubator.door: open}")),
    in_plant(
        "A fact is written otherwise.",
        ("free_while: {reader: {lid: open}}", "free_while: {reader: {lid: opened}}"),
    ),
    in_plant("Home lies in a zone.", ("{poses: [lab nest]}", "{poses: [lab nest, lab home]}")),
    in_plant(
        "The doser has no home.",
        (
            "home:   {loader: {deg: [0, 0], mm: 0}, doser: {deg: [0, 0], mm: 0}}",
            "home:   {loader: {deg: [0, 0], mm: 0}}",
        ),
    ),
    in_plant(
        "The wait for zones is shorter than the work in them.",
        ("  store:\n    devices:", "  store:\n    zone_wait_s: 0.5\n    devices:"),
    ),
    in_plant(
        "The reader lets go where it is to hold.",
        ("sets: {clamped: $on}, holds", "sets: {clamped: false}, holds"),
    ),
    in_plant(
        "The incubator takes longer than its time.",
        ("takes_s: 8\n        at_most_s: 40", "takes_s: 80\n        at_most_s: 40"),
    ),
)
PLANT_BUGS = (*OF_PLANTS, *OF_WORDS)
