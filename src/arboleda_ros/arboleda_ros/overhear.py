"""Commands of others to robots that speak ROS 2 themselves, with no bridge between: the plant listens."""

from __future__ import annotations

import threading
from collections import deque
from typing import Any

from std_msgs.msg import Float32MultiArray, String, UInt8

Content = tuple[tuple[float | str, ...], tuple[str, ...]]
KEPT = 20  # own messages that may still be heard; a lost one must not be expected for ever


class OwnTopic:
    """A topic on which the plant speaks and listens: tells its own messages from those of others.

    rclpy does not say whose a message is. What is heard as often as it was said is the plant's own.
    """

    def __init__(self) -> None:
        self._sent: deque[Content] = deque(maxlen=KEPT)
        self._lock = threading.Lock()  # the plant speaks on its own thread, and hears on that of the link

    def say(self, message: Float32MultiArray | UInt8 | String) -> None:
        """Note a message; call it before the message is published."""
        with self._lock:
            self._sent.append(_content(message))

    def is_own(self, message: Any) -> bool:
        """True if a heard message is one of this process's own; each of these is recognised once."""
        with self._lock:
            try:
                self._sent.remove(_content(message))
            except ValueError:
                return False
            return True


def _content(message: Float32MultiArray | UInt8 | String) -> Content:
    if isinstance(message, UInt8 | String):
        return (message.data,), ()
    return tuple(message.data), tuple(dim.label for dim in message.layout.dim)
