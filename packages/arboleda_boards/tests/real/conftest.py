"""A command line, a broker and the firmware's boards, as tests of the whole system have them."""

from tests.system.conftest import arboleda, board, compiled_board, device_board, mosquitto, start

__all__ = ["arboleda", "board", "compiled_board", "device_board", "mosquitto", "start"]
