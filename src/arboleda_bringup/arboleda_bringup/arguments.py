"""The arguments of plant.launch.py."""

from __future__ import annotations

from dataclasses import dataclass

SWITCH = ("true", "false")
EMBEDDED = "embedded"
AUTO = "auto"


@dataclass(frozen=True, kw_only=True)
class Argument:
    """One argument; `choices` are the allowed texts, None where any text may be right."""

    name: str
    default: str
    description: str
    choices: tuple[str, ...] | None = None


ARGUMENTS = (
    Argument(name="plant", default="", description="plant file; empty: the shipped plant"),
    Argument(
        name="sim",
        default="true",
        choices=SWITCH,
        description="virtual boards; false: real ones on the broker",
    ),
    Argument(
        name="broker",
        default=EMBEDDED,
        description="MQTT broker as HOST:PORT; embedded: the launch brings its own, which needs sim:=true",
    ),
    Argument(
        name="orchestrator",
        default="true",
        choices=SWITCH,
        description="the orchestrator of Arboleda; false: the bridge works alone, for one of your own",
    ),
    Argument(
        name="dashboard",
        default="true",
        choices=SWITCH,
        description="the page, in the process of the orchestrator",
    ),
    Argument(name="port", default="", description="port of the page; empty: 8080, or a free one"),
    Argument(name="rviz", default="true", choices=SWITCH, description="RViz2 with the shipped view"),
    Argument(
        name="describe",
        default=AUTO,
        choices=(AUTO, *SWITCH),
        description="robot_description and TF of each robot, by robot_state_publisher; auto: as rviz",
    ),
    Argument(
        name="state_dir",
        default="",
        description="where the plant keeps its state; empty: $XDG_STATE_HOME/arboleda/<plant name>",
    ),
    Argument(name="rate", default="1.0", description="speed of the virtual boards, 0.1 to 100; 1 is real"),
)
