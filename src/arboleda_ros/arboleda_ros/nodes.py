"""Executables of this package; their libraries are imported only when one of them runs."""

from __future__ import annotations

import sys

from arboleda_ros.missing_libraries import sentence

NAMES = ("orchestrator", "mqtt_bridge", "virtual_devices")


def orchestrator() -> int:
    """Run the plant itself: tasks in, commands out."""
    return main("orchestrator")


def mqtt_bridge() -> int:
    """Run the bridge between ROS 2 and the boards on MQTT."""
    return main("mqtt_bridge")


def virtual_devices() -> int:
    """Run simulated boards."""
    return main("virtual_devices")


def main(name: str) -> int:
    """Run the node `name` until a signal; 0 at a clean end, 1 where it cannot start."""
    try:
        from arboleda_ros.running import run

        return run(name)
    except KeyboardInterrupt:
        return 0
    except ImportError as error:
        print(f"{name}: {sentence(error)}", file=sys.stderr)
        return 1


def _chosen() -> str:
    if len(sys.argv) > 1 and sys.argv[1] in NAMES:
        return sys.argv.pop(1)
    sys.exit(f"usage: python -m arboleda_ros.nodes {{{','.join(NAMES)}}} [--ros-args -p plant:=FILE ...]")


if __name__ == "__main__":
    sys.exit(main(_chosen()))
