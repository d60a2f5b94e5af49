"""A command line, a broker and clients of it, as tests of adapters and of the whole system have them."""

from importlib.util import find_spec

from tests.contract.conftest import lab, mosquitto, patient_messages, peer, raw_peer, trusts
from tests.system.conftest import arboleda, start

__all__ = ["arboleda", "lab", "mosquitto", "patient_messages", "peer", "raw_peer", "start", "trusts"]

collect_ignore = [] if find_spec("control_msgs") else ["test_mixed_ros2.py"]  # no wheels have it
if not all(map(find_spec, ("control_msgs", "nav2_msgs"))):
    collect_ignore = [*collect_ignore, "ros_action/test_virtual_actions.py"]
if not find_spec("turtlesim"):
    collect_ignore = [*collect_ignore, "ros_mapping/test_turtle.py"]
