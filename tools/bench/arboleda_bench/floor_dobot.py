"""The floor of `dobot`: a bare client that moves an arm to and fro, and looks for the end in every frame."""

from __future__ import annotations

import socket
import struct
import sys

SIZE, IDLE, NEAR_DEG = 1440, 5, 0.005
HOST = "127.0.0.1"
ANGLES_DEG = (0.5, 1.3, 0.2, 1.9, 0.9, 2.63, 0.41, 1.57, 1.2, 0.33, 2.17)  # where joint 1 goes, in turn


def main(port: int, feedback_port: int, moves: int) -> None:
    goals = [ANGLES_DEG[move % len(ANGLES_DEG)] for move in range(moves)]
    lines = [f"MovJ(joint={{{goal:.4f},0,0,0,0,0}})".encode() for goal in goals]
    dashboard, fed = (socket.create_connection((HOST, each)) for each in (port, feedback_port))
    dashboard.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    for goal, line in zip(goals, lines, strict=True):
        dashboard.sendall(line)
        reply = dashboard.recv(1024).decode()
        number = int(reply.split("{")[1].split("}")[0])
        while not _is_over(_frame(fed), number, goal):
            pass


def _frame(fed: socket.socket) -> bytes:
    frame = b""
    while len(frame) < SIZE:
        frame += fed.recv(SIZE - len(frame))
    return frame


def _is_over(frame: bytes, number: int, goal_deg: float) -> bool:
    mode, command = struct.unpack_from("<Q", frame, 24)[0], struct.unpack_from("<Q", frame, 1112)[0]
    joints = struct.unpack_from("<6d", frame, 432)
    return bool(mode == IDLE and command == number and abs(joints[0] - goal_deg) < NEAR_DEG)


if __name__ == "__main__":
    main(*map(int, sys.argv[1:]))
