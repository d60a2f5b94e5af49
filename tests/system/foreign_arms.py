"""Arms that are not ours: `foreign_arms.py ros|mqtt PLANT [BROKER_PORT]` plays every arm of a plant file.

Each drives its joints at a constant speed, behind glue that reads and tells state and position on their own:
every word is up to two telemetry periods late, so either may come first. They tell the time by their own
ticks: a busy machine makes these late, and no word later than two periods. On ROS 2 they are two topics, the
state told at changes; over MQTT one message holds what was read last of each. Of a move of no length some say
moving for a period, some nothing. Effectors tell nothing.
"""

from __future__ import annotations

import sys
import threading
from collections import deque
from contextlib import suppress
from pathlib import Path
from random import Random
from typing import Any

from arboleda.kinds.arm import Arm
from arboleda.model.messages import MotionState
from arboleda.model.plant_model import Link
from arboleda.plant_file import loader
from arboleda.testing.storage_layout import StorageLayout
from arboleda.wire.payloads import Channel, JointsGoal, Presence, StopGoal, Telemetry, decode, encode
from arboleda.wire.topics import topic
from arboleda.wire.units import from_wire, to_wire

TICK_S, PERIOD_S, LATE_S = 0.01, 0.1, 0.2
SPEED = 0.9  # of what each joint may do
MOVING, STOPPED = MotionState.MOVING, MotionState.STOPPED


class Glued:
    """One arm; `place` and `state` are what its glue tells, each of an instant of its own."""

    def __init__(self, arm: Arm, number: int) -> None:
        self.arm = arm
        self.place: tuple[float, ...] = arm.reference
        self.state = STOPPED
        self.changed = True  # whether the state that is told is another one
        self._q = self._goal = arm.reference
        self._now = self._moves_until = 0.0
        self._is = STOPPED
        self._silent = number % 2 == 1
        self._random = Random(number)
        self._places: deque[tuple[float, tuple[float, ...]]] = deque()
        self._states: deque[tuple[float, MotionState]] = deque()

    def goal(self, q: tuple[float, ...]) -> None:
        """Drive there."""
        self._goal = self.arm.motion.quantised(q)
        rows = zip(self.arm.joints, self._q, self._goal, strict=True)
        travel_s = max(abs(goal - q) / (joint.speed * SPEED) for joint, q, goal in rows)
        self._moves_until = self._now + (travel_s or (0.0 if self._silent else PERIOD_S))

    def stop(self) -> None:
        """Stay where it is."""
        self._goal, self._moves_until = self._q, 0.0

    def tick(self, *, read: bool) -> None:
        """TICK_S of its time; `read`: the joints are read in it."""
        self._now += TICK_S
        rows = zip(self.arm.joints, self._q, self._goal, strict=True)
        self._q = tuple(q + _within(goal - q, joint.speed * SPEED * TICK_S) for joint, q, goal in rows)
        state = MOVING if self._now < self._moves_until or self._q != self._goal else STOPPED
        if state is not self._is:
            self._is = state
            self._states.append((self._later(self._states), state))
        if read:
            self._places.append((self._later(self._places), self._q))
        while self._places and self._places[0][0] <= self._now:
            self.place = self._places.popleft()[1]
        if self._states and self._states[0][0] <= self._now:
            self.state, self.changed = self._states.popleft()[1], True

    def _later(self, queue: deque[Any]) -> float:
        """When a word of now is told: not before those that came before it."""
        return max(self._now + self._random.uniform(0.0, LATE_S), queue[-1][0] if queue else 0.0)


def _within(way: float, most: float) -> float:
    return max(-most, min(most, way))


def play_ros(arms: list[Glued]) -> None:
    """Two topics each, on ROS 2."""
    import rclpy
    from rclpy.executors import ExternalShutdownException
    from sensor_msgs.msg import JointState
    from std_msgs.msg import Float32MultiArray, UInt8

    from arboleda_ros import qos

    rclpy.init()
    node = rclpy.create_node("foreign_arms")
    states = [node.create_publisher(UInt8, f"{each.arm.name}/motion_state", qos.COMMAND) for each in arms]
    joints = [node.create_publisher(JointState, f"{each.arm.twin}/joint_states", 10) for each in arms]
    for each in arms:
        node.create_subscription(
            Float32MultiArray,
            f"{each.arm.name}/joint_goals_q",
            lambda goal, each=each: each.goal(tuple(goal.data)),
            qos.COMMAND,
        )
        node.create_subscription(
            UInt8, f"{each.arm.name}/stop_cmd", lambda stop, each=each: stop.data and each.stop(), qos.COMMAND
        )
    ticks = 0

    def tick() -> None:
        nonlocal ticks
        ticks += 1
        for number, each in enumerate(arms):
            each.tick(read=ticks % 10 == number % 10)
            if each.changed or ticks % 100 == number % 100:  # who listens late hears it within a second
                each.changed = False
                states[number].publish(UInt8(data=each.state.value))
            if ticks % 10 == number % 10:
                names = [f"{each.arm.twin}_{joint.name}" for joint in each.arm.joints]
                joints[number].publish(JointState(name=names, position=list(each.place)))

    node.create_timer(TICK_S, tick)
    print("foreign arms play", flush=True)
    with suppress(KeyboardInterrupt, ExternalShutdownException):
        rclpy.spin(node)


def play_mqtt(arms: list[Glued], port: int) -> None:
    """One message each every period, and at each change of the state, over MQTT."""
    import paho.mqtt.client as mqtt

    lock = threading.Lock()
    by_topic = {
        topic(each.arm.mqtt, channel): (each, channel)
        for each in arms
        for channel in (Channel.JOINTS, Channel.STOP)
    }
    client = mqtt.Client(mqtt.CallbackAPIVersion.VERSION2)

    def hear(client: Any, data: Any, message: mqtt.MQTTMessage) -> None:
        each, channel = by_topic[message.topic]
        said = decode(channel, message.payload, axes=len(each.arm.joints))
        with lock:
            if isinstance(said, JointsGoal):
                rows = zip(each.arm.joints, said.q_deg, strict=True)
                each.goal(tuple(from_wire(joint, value) for joint, value in rows))
            elif isinstance(said, StopGoal) and said.mode:
                each.stop()

    client.on_message = hear
    client.connect("127.0.0.1", port)
    client.subscribe([(address, 1) for address in by_topic])
    client.loop_start()
    for each in arms:
        client.publish(topic(each.arm.mqtt, Channel.PRESENCE), encode(Presence(online=True)), 1, retain=True)
    print("foreign arms play", flush=True)
    ticks, stop = 0, threading.Event()
    while not stop.wait(TICK_S):
        ticks += 1
        for number, each in enumerate(arms):
            with lock:
                each.tick(read=ticks % 10 == number % 10)
            if each.changed or ticks % 10 == number % 10:
                each.changed = False
                rows = zip(each.arm.joints, each.place, strict=True)
                place = tuple(to_wire(joint, value) for joint, value in rows)
                said = Telemetry(state=each.state, q_deg=place, node=None)
                client.publish(topic(each.arm.mqtt, Channel.TELEMETRY), encode(said))


def main(how: str, plant: str, port: str = "0") -> None:
    link = Link.ROS if how == "ros" else Link.MQTT
    cells = loader.load(Path(plant)).cells
    arms = [
        Glued(StorageLayout(cell).arm, number)
        for number, cell in enumerate(cells)
        if StorageLayout(cell).arm.link is link
    ]
    if how == "ros":
        play_ros(arms)
    else:
        play_mqtt(arms, int(port))


if __name__ == "__main__":
    main(*sys.argv[1:])
