"""Start the virtual controllers of this example, and its plant; Ctrl-C ends all of it.

python examples/mixed/start.py "line deliver slot_1 200"
python examples/mixed/start.py --ros2 "line ship slot_1 200"       where ROS 2 with control_msgs is sourced
"""

from __future__ import annotations

import signal
import subprocess
import sys
from pathlib import Path

ARBOLEDA = Path(sys.executable).with_name("arboleda")  # of the same installation
HERE = Path(__file__).parent
CONTROLLERS = [["dobot", "--enabled"], ["modbus"], ["vda5050"]]
WITH_ROS2 = [["trajectory"], ["gripper"]]
ANY_PORT = ["--fault-port", "0"]


def controller(options: list[str]) -> subprocess.Popen[str]:
    """A virtual controller that listens; in a session of its own, so that Ctrl-C is for the plant first."""
    command = [ARBOLEDA, "virtual", *options, *ANY_PORT]
    process = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, start_new_session=True)
    assert process.stdout is not None
    for _ in range(2):  # what it is, and where its faults are switched
        print(process.stdout.readline(), end="", flush=True)
    return process


def main(options: list[str]) -> int:
    ros2 = "--ros2" in options
    plant = HERE / ("plant_ros2.yaml" if ros2 else "plant.yaml")
    running: list[subprocess.Popen[str]] = []
    try:
        for each in CONTROLLERS + (WITH_ROS2 if ros2 else []):
            running.append(controller(each))
        if any(each.poll() is not None for each in running):
            return 1  # it has said why
        tasks = [each for each in options if each != "--ros2"]
        up = ["up", *tasks, "--plant", str(plant), "--boards", "drivers", "--no-ros"]
        plant_process = subprocess.Popen([ARBOLEDA, *up])
        signal.signal(signal.SIGINT, lambda *_: None)  # Ctrl-C is for the plant, which halts what moves
        return plant_process.wait()
    except KeyboardInterrupt:
        return 0
    finally:
        for each in running:
            each.terminate()
            each.wait()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
