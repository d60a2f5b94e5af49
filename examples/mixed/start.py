"""Start the two virtual controllers of this example, and its plant; Ctrl-C ends all of it.

python examples/mixed/start.py "line deliver slot_1 200"
"""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

ARBOLEDA = Path(sys.executable).with_name("arboleda")  # of the same installation
PLANT = Path(__file__).with_name("plant.yaml")
CONTROLLERS = [["dobot", "--enabled"], ["modbus"]]
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
    running: list[subprocess.Popen[str]] = []
    try:
        for each in CONTROLLERS:
            running.append(controller(each))
        if any(each.poll() is not None for each in running):
            return 1  # it has said why
        up = ["up", *options, "--plant", str(PLANT), "--boards", "drivers", "--no-ros"]
        return subprocess.run([ARBOLEDA, *up], check=False).returncode
    except KeyboardInterrupt:
        return 0
    finally:
        for each in running:
            each.terminate()
            each.wait()


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
