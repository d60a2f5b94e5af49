"""What drawn plants with cells of devices have found: each plant, as much of it as was needed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import pytest
import yaml

from arboleda_drawn.plants import loaded
from arboleda_proofs.simulator.faults import Fault
from arboleda_proofs.simulator.run import Simulation
from arboleda_proofs.simulator.shrink import explicit


@dataclass(frozen=True, kw_only=True)
class Found:
    """A breach: the plant file and the files beside it, the seed of the people, and what went wrong."""

    file: str
    beside: Mapping[str, str] = field(default_factory=dict)
    seed: int = 1
    seconds: float = 60.0
    faults: tuple[Fault, ...] = ()


SET_AND_BAKE = """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    oven = cell.device("oven")
    return work(oven.put(to="up"), oven.bake())
"""

DOWN_AND_UP = """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    mill = cell.device("mill")
    return work(mill.put(to="down"), mill.put(to="up"))
"""

FOUND = {
    "a shared arm was judged by the targets of another cell that have the same names": Found(
        file="""
            name: drawn_1005
            uses: [recipes.py]
            shared:
              our_loader: {kind: arm, model: scara}
              our_tool: {kind: gripper, tool_of: our_loader}
            cells:
              cell:
                devices: {loader: {shared: our_loader}, tool: {shared: our_tool}, eye: {kind: camera}}
                targets:
                  home: {loader: {deg: [0, 0], mm: 0}}
                  tray: {loader: {deg: [34.57, -38.59], mm: 80}}
              cell_2:
                devices: {loader: {shared: our_loader}, tool: {shared: our_tool}, lens: {kind: camera}}
                targets:
                  home: {loader: {deg: [0, 0], mm: 0}}
                  tray: {loader: {deg: [41.57, -38.59], mm: 80}}
                places: {tray: {}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    tool, loader = cell.devices("tool", "loader")
    return work(tool.close(width_mm=30, force_n=5), loader.visit("tray", tool.open()))
"""
        },
    ),
    "a device kept the zone of a verb that was done in the instant in which it was told": Found(
        file="""
            name: drawn_302
            uses: [recipes.py]
            kinds:
              one:
                facts: {mode: [up, down]}
                verbs: {put: {effect: switch, with: {to: [up, down]}, sets: {mode: $to}}}
            cells:
              cell: {devices: {oven: {kind: one}, lamp: {kind: one}}, zone_wait_s: 3600}
            zones:
              mouth: {free_while: {oven: {mode: up}}, held_while: {lamp: [put]}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    oven, lamp = cell.devices("oven", "lamp")
    return work(oven.put(to="up"), lamp.put(to="up"), oven.put(to="down"), oven.put(to="up"))
"""
        },
    ),
    "a step that was left in the instant in which it began had not been seen to begin": Found(
        file="""
            name: drawn_203
            uses: [recipes.py]
            cells: {cell: {devices: {eye: {kind: camera}}}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    eye = cell.device("eye")
    return work(cell.fallback(cell.timeout(cell.wait(1), 0), cell.wait(0.5)), eye.look())
"""
        },
    ),
    "who answered seven questions of one recipe had not led its cell to work": Found(
        seconds=120.0,
        file="""
            name: drawn_76
            uses: [recipes.py]
            cells: {cell: {devices: {ana: {kind: person}}}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    ana = cell.device("ana")
    return work([ana.ask(f"Is part {number} good?", ["sí", "no"], at_most_s=900) for number in range(8)])
"""
        },
    ),
    "a board that lies about its boot comes to the end of a switch that a boot would have ended": Found(
        faults=(Fault(kind="lying_telemetry", at=20.5, seconds=1.0, target="mill", word="arranque", seed=1),),
        file="""
            name: drawn_50020
            uses: [recipes.py]
            kinds:
              one:
                facts: {level: [up, down]}
                verbs: {put: {effect: switch, with: {to: [up, down]}, sets: {level: $to}, takes_s: 4}}
            cells: {cell: {devices: {mill: {kind: one}, eye: {kind: camera}}}}
            zones:
              mouth: {free_while: {mill: {level: up}}, held_while: {eye: [look]}}
        """,
        beside={"recipes.py": DOWN_AND_UP},
    ),
    "a board that lies about what it has taken is told its step again after a start": Found(
        faults=(
            Fault(kind="plant_crash", at=35.0, target="plant"),
            Fault(kind="lying_telemetry", at=35.3, seconds=10.0, target="mill", word="ack", seed=6),
        ),
        file="""
            name: drawn_50085
            uses: [recipes.py]
            kinds:
              one:
                facts: {level: [up, down]}
                verbs: {put: {effect: switch, with: {to: [up, down]}, sets: {level: $to}, takes_s: 10}}
            cells: {cell: {devices: {mill: {kind: one}}, on_restart: go_on}}
        """,
        beside={"recipes.py": DOWN_AND_UP},
    ),
    "work that an alarm had ended beside a switch without end was cut short by the next": Found(
        seconds=90.0,
        faults=(
            Fault(kind="never_ends", at=0.1, seconds=20.0, target="oven", seed=1),
            Fault(kind="driver_alarm", at=10.0, seconds=0.5, target="oven", seed=1),
        ),
        file="""
            name: drawn_52153
            uses: [recipes.py]
            kinds:
              one:
                facts: {mode: [up, down]}
                verbs:
                  put: {effect: switch, with: {to: [up, down]}, sets: {mode: $to}}
                  bake: {effect: process, takes_s: 1, on_stop: finish}
            cells: {cell: {devices: {oven: {kind: one}}}}
        """,
        beside={"recipes.py": SET_AND_BAKE},
    ),
    "an alternative went on with a machine clamped, because its work was cut short": Found(
        faults=(Fault(kind="gives_up", at=5.0, seconds=15.0, target="press", word="atasco"),),
        file="""
            name: drawn_80229
            uses: [recipes.py]
            kinds:
              press:
                facts: {clamped: bool}
                verbs:
                  clamp: {effect: switch, with: {"on": bool}, sets: {clamped: $on}, holds: part}
                  press: {effect: motion, takes_s: 2}
            cells:
              cell:
                devices: {loader: {kind: arm, model: scara}, press: {kind: press}}
                targets:
                  home: {loader: {deg: [0, 0], mm: 0}}
                  tray: {loader: {deg: [34.57, -38.59], mm: 80}}
                places: {tray: {}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    press = cell.device("press")
    clamped = work(press.clamp(on=True), press.press(), press.clamp(on=False))
    return work(cell.fallback(clamped, cell.wait(0.5)))
"""
        },
    ),
    "a press went down in a zone that was free since it was given up at a bridge that hears late": Found(
        seconds=30.0,
        faults=(
            Fault(kind="hop_delay", at=5.0, seconds=8.0, target="plant", amount=1.134, word="to bridge"),
        ),
        file="""
            name: drawn_77185
            uses: [recipes.py]
            kinds:
              one:
                facts: {mode: [up, down]}
                verbs: {put: {effect: switch, with: {to: [up, down]}, sets: {mode: $to}}}
              press:
                facts: {door: [up, down]}
                verbs:
                  move:
                    {effect: motion, with: {to: [up, down]}, sets: {door: $to}, takes_s: 0.2, at_most_s: 0.6}
            cells:
              cell: {devices: {oven: {kind: one}, press: {kind: press}}, retry: {times: 3}}
            zones:
              mouth: {free_while: {oven: {mode: up}}, held_while: {press: [move]}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    press = cell.device("press")
    return work(press.move(to="down"), cell.wait(1), press.move(to="up"))
"""
        },
    ),
    "a process without a duration was never told by a device that tells its state of another instant": Found(
        seed=2,
        file="""
            name: drawn_52036
            uses: [recipes.py]
            kinds:
              one:
                facts: {mode: [up, down]}
                verbs:
                  put: {effect: switch, with: {to: [up, down]}, sets: {mode: $to}}
                  bake: {effect: process, sets: {mode: down}, on_stop: finish}
            cells: {cell: {devices: {oven: {kind: one, evidence: facts}}}}
        """,
        beside={"recipes.py": SET_AND_BAKE},
    ),
    "a task failed that had not touched the output of which a person meanwhile said that it is full": Found(
        faults=(
            Fault(kind="bridge_stall", at=12.0, seconds=3.0, target="bridge"),
            Fault(kind="operator_load", at=14.0, target="cell", word="bin"),
        ),
        file="""
            name: drawn_22
            uses: [recipes.py]
            kinds: {oven: {verbs: {bake: {effect: process, takes_s: 6}}}}
            cells:
              cell:
                devices: {loader: {kind: arm, model: scara}, oven: {kind: oven}}
                targets:
                  home: {loader: {deg: [0, 0], mm: 0}}
                  bin: {loader: {deg: [40, 40], mm: 40}}
                places: {bin: {holds: 20, output: true}}
        """,
        beside={
            "recipes.py": """
from arboleda.recipes import recipe, work


@recipe("do_1")
def do_1(cell):
    return work(cell.device("oven").bake())
"""
        },
    ),
}


@pytest.mark.sampled(9)
@pytest.mark.parametrize("found", FOUND.values(), ids=FOUND)
def test_every_invariant_holds(found: Found) -> None:
    plant = loaded(yaml.safe_load(found.file), found.beside)
    result = Simulation(plant.model, found.seed, explicit(found.faults)).run(seconds=found.seconds)
    assert result.broken is None, str(result.broken)
    assert len(result.faults) == len(found.faults), "each of them happened"
    assert result.outcomes.get("done", 0) > 0
