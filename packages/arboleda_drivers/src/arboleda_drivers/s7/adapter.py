"""The driver `s7`: Siemens S7-300, 400, 1200 and 1500 by their absolute addresses, by python-snap7."""

from __future__ import annotations

import logging
from collections.abc import Hashable, Iterator
from typing import TYPE_CHECKING, Any

from arboleda.drivers import Command, DriverError, Report, Robot, driver
from arboleda_drivers.connections.abrupt import end_abruptly
from arboleda_drivers.plc import polled
from arboleda_drivers.plc.handshake import Read
from arboleda_drivers.plc.plc_snapshot import Writing
from arboleda_drivers.s7.addresses import Area, address
from arboleda_drivers.s7.machine import LEAST_PDU, Block, S7Device, WriteRequest
from arboleda_drivers.s7.settings import Settings

if TYPE_CHECKING:
    from snap7.connection import ISOTCPConnection
    from snap7.datatypes import S7Area

MISSING = "python-snap7 is not installed, which it needs: pip install 'arboleda[s7]'"
PDU = 960  # the longest message that any S7 agrees to
PROGRAMMING_DEVICE = 0x0100  # the kind of connection that every CPU keeps a place for
LOCAL_TSAP = 0x0100
GOOD = 0xFF
HEADER = 12  # bytes of an answer before its parameters
NUMBER = slice(4, 6)  # of a request, and of the answer to it
CODES = {
    0x01: "hardware_fault",
    0x03: "access_denied",
    0x05: "address_out_of_range",
    0x06: "type_not_supported",
    0x07: "type_inconsistent",
    0x0A: "no_such_block",
}
"""The return codes of one value, as Wireshark and python-snap7 name them."""
HINT = "is PUT/GET permitted, and the block without optimised access?"


class Line(polled.Line):
    """Connection to a PLC; every request is one message, and none is sent twice."""

    def __init__(self, settings: Settings) -> None:
        super().__init__()
        self._settings = settings
        self._connection: ISOTCPConnection | None = None
        self._protocol: Any = None
        self.pdu = LEAST_PDU  # bytes of a message, as agreed upon

    def open(self) -> ISOTCPConnection:
        """The connection, made unless there is one; raises ConnectionError if nobody answers."""
        if self._connection is None:
            from snap7.connection import ISOTCPConnection
            from snap7.error import S7Error
            from snap7.s7protocol import S7Protocol

            settings = self._settings
            remote = PROGRAMMING_DEVICE | settings.rack << 5 | settings.slot
            made = ISOTCPConnection(settings.host, settings.port, LOCAL_TSAP, remote)
            try:
                made.connect(settings.timeout_s)
            except S7Error as error:
                raise ConnectionError(f"{settings.peer} is not there: {error}") from error
            assert made.socket is not None
            end_abruptly(made.socket)
            self._connection, self._protocol = made, S7Protocol()
            self.pdu = self._agreed()
        return self._connection

    def hang_up(self) -> None:
        if self._connection is not None:
            self._connection.disconnect()
            self._connection = None

    def read(self, block: Block) -> bytes:
        """The bytes of a block."""
        from snap7.datatypes import S7WordLen

        place = f"{block.area}{block.db or ''} from byte {block.byte} on, {block.length} bytes"
        with self.turn():
            self.open()
            request = self._protocol.build_read_request(
                _area(block.area), block.db, block.byte, S7WordLen.BYTE, block.length
            )
            answer = self._answer(request, f"to show {place}")
            return bytes(self._protocol.extract_read_data(answer, S7WordLen.BYTE, block.length))

    def write(self, put: WriteRequest) -> None:
        """Write one value; a bit by itself, so that its neighbours in the byte stay as they are."""
        from snap7.datatypes import S7WordLen

        at = put.place
        start, width = at.byte, S7WordLen.BYTE
        if at.bit is not None:
            start, width = 8 * at.byte + at.bit, S7WordLen.BIT
        with self.turn():
            self.open()
            request = self._protocol.build_write_request(_area(at.area), at.db, start, width, put.raw)
            self._protocol.check_write_response(self._answer(request, f"to take {at.text}"))

    def _agreed(self) -> int:
        """The length of messages that the PLC agrees to."""
        request = self._protocol.build_setup_communication_request(pdu_length=PDU)
        parameters = self._answer(request, "to talk").get("parameters") or {}
        agreed = parameters.get("pdu_length")
        if not isinstance(agreed, int) or not LEAST_PDU <= agreed <= PDU:
            peer = self._settings.peer
            raise ConnectionError(
                f"{peer} agrees to messages of {agreed} bytes; allowed: {LEAST_PDU} to {PDU}"
            )
        return agreed

    def _answer(self, request: bytes, what: str) -> dict[str, Any]:
        """The answer to a request; raises RequestRefused where the PLC says that it does not do it."""
        from snap7.error import S7ProtocolError

        connection = self._connection
        assert connection is not None
        connection.send_data(request)
        frame = connection.receive_data()
        if frame[NUMBER] != request[NUMBER]:
            raise ConnectionError(f"{self._settings.peer} has answered to another request")
        try:
            answer: dict[str, Any] = self._protocol.parse_response(frame)
        except S7ProtocolError as error:
            if error.error_code is None:
                code = _code(frame)
                if code in CODES:  # some say a length beside it of bytes that do not follow
                    raise ConnectionError(str(_item_refused(what, code))) from error
                raise
            raise refused(what, f"error_{error.error_code:04x}", str(error)) from error
        code = (answer.get("data") or {}).get("return_code", GOOD)
        if code != GOOD:
            raise _item_refused(what, code)
        return answer


LINES: polled.Lines[Line] = polled.Lines()


@driver("s7", settings=Settings)
class S7(polled.Polled[Settings, Line, WriteRequest]):
    """Driver of one device behind a Siemens S7."""

    protocol = "s7"
    lines = LINES

    def prepare(self, device: Robot) -> None:
        need_library()
        self._device = S7Device(device, self._settings)

    def address(self) -> Hashable:
        settings = self._settings
        return (settings.host, settings.port, settings.rack, settings.slot, settings.timeout_s)

    def make_line(self) -> Line:
        return Line(self._settings)

    def begin(self, line: Line) -> None:
        with line.turn():
            line.open()
        self._blocks = self._device.blocks(line.pdu)
        for _ in self.reads(line):
            pass
        with self._machine:
            self._device.begin(self._values)

    def reads(self, line: Line) -> Iterator[None]:
        raw: dict[Block, bytes] = {}
        for block in self._blocks:
            raw[block] = line.read(block)
            yield
        self._values: Read = self._device.values(raw)

    def report(self, at: float) -> Report:
        return self._device.report(at, self._values)

    def writing(self, command: Command) -> Writing[WriteRequest]:
        return self._device.order(command)

    def write(self, line: Line, put: WriteRequest) -> None:
        line.write(put)

    def heartbeat(self, number: int) -> WriteRequest | None:
        if self._settings.heartbeat is None:
            return None
        at = address(self._settings.heartbeat)
        return WriteRequest(place=at, raw=at.raw(number % (at.greatest + 1)))


def refused(what: str, word: str, reason: str) -> polled.RequestRefused:
    """The error of a PLC that does not do what was asked."""
    return polled.RequestRefused(f"the PLC refuses {what}: {reason}; {HINT}", word)


def _item_refused(what: str, code: int) -> polled.RequestRefused:
    word = CODES.get(code, f"code_{code:02x}")
    return refused(what, word, f"{word} (return code 0x{code:02x})")


def _code(frame: bytes) -> int | None:
    """The return code of the value in an answer; None if it has none."""
    at = HEADER + int.from_bytes(frame[6:8], "big")
    return frame[at] if at < len(frame) else None


def need_library() -> None:
    """Raises DriverError with install advice if python-snap7 is missing; otherwise silences its log."""
    try:
        import snap7.s7protocol as found
    except ImportError as error:
        raise DriverError(MISSING) from error
    log = logging.getLogger(found.__name__.partition(".")[0])
    log.setLevel(logging.CRITICAL)  # the plant reports the same


def _area(area: Area) -> S7Area:
    from snap7.datatypes import S7Area

    return {"DB": S7Area.DB, "M": S7Area.MK, "I": S7Area.PE, "Q": S7Area.PA}[area]
