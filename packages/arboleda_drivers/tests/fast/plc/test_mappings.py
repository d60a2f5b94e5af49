"""Mappings of PLCs in a plant file: what is wrong is told with its place and what to write."""

from __future__ import annotations

from pathlib import Path

import pytest

from arboleda.model.errors import ConfigError
from arboleda.plant_file import loader, settings
from arboleda.plant_file.document import Document

from .plcs import EACH, EXAMPLE, PLCS

WRONG = [
    line.replace(r"\n", "\n").split("\t")
    for line in (Path(__file__).parent / "wrong_mappings.tsv").read_text("utf-8").splitlines()[1:]
]


def text_of(plc: str) -> str:
    return (EXAMPLE / PLCS[plc].file).read_text("utf-8")


def problems(plc: str, old: str, new: str) -> tuple[str, ...]:
    """Problems of the belt's mapping with this change of the plant file."""
    text, keys = text_of(plc), PLCS[plc].settings
    assert text.count(old) == 1, old
    document = Document("plant.yaml", text.replace(old, new).encode())
    place = ("cells", "line", "devices", "belt", "driver", plc)
    try:
        read = settings.read(document, place, settings.shape(plc, keys), keys)
        for inside, sentence in read.problems(PLCS[plc].device) if read is not None else ():
            document.problem((*place, *inside), sentence)
    except settings.SettingsRefused as unfit:
        document.problem(unfit.place, str(unfit))
    try:
        document.finish()
    except ConfigError as error:
        return error.problems
    return ()


@pytest.mark.parametrize(
    ("plc", "old", "new"),
    [
        ("modbus", "name: plc_conveyor", "name: another"),
        ("opcua", "name: opcua_conveyor", "name: another"),
        ("s7", "name: s7_conveyor", "name: another"),
        ("s7", "accepted: DB1.DBW6", "busy: DB1.DBX6.0"),
        ("s7", "load: {write: [{at: DB2.DBB0, value: 1}]}", "load: {write: [{at: M0.0, value: true}]}"),
        ("s7", '{at: "DB2.DBD4:DINT", value: $speed_mm_s}', "{at: DB2.DBW4, value: $speed_mm_s}"),
        ("s7", "- {at: DB2.DBB0, value: 3}", "- {at: DB2.DBX0.0, value: $to, words: {closed: 0, open: 1}}"),
        ("s7", "heartbeat: DB2.DBW10", "heartbeat: MB7"),
    ],
)
def test_a_mapping_that_is_good(plc: str, old: str, new: str) -> None:
    assert problems(plc, old, new) == ()


@pytest.mark.parametrize(
    ("plc", "old", "new", "told"),
    [
        ("modbus", "scan: {write", "scna: {write", "47:21: {}.verbs.scna: a belt has no verb scna"),
        (
            "modbus",
            "mm_s: {input: 11}",
            "mm_s: {input: -1}",
            "35:21: {}.facts.mm_s: input -1 is out of range",
        ),
        ("opcua", "load: {call", "lode: {call", "36:21: {}.verbs.lode: a belt has no verb lode"),
    ],
)
def test_what_is_wrong_is_told_with_file_and_line(
    tmp_path: Path, plc: str, old: str, new: str, told: str
) -> None:
    (tmp_path / "recipes.py").write_text((EXAMPLE / "recipes.py").read_text("utf-8"), "utf-8")
    (tmp_path / "plant.yaml").write_text(text_of(plc).replace(old, new), "utf-8")
    with pytest.raises(ConfigError) as raised:
        loader.load(tmp_path / "plant.yaml")
    where = f"cells.line.devices.belt.driver.{plc}"
    assert "plant.yaml:" + told.format(where) in str(raised.value)


@pytest.mark.sampled(3)
@pytest.mark.parametrize(("plc", "old", "new", "told"), WRONG)
def test_what_is_wrong_has_its_place_and_a_hint(plc: str, old: str, new: str, told: str) -> None:
    found = problems(plc, old, new)
    assert any(told in each for each in found), found
    assert all("plant.yaml:" in each for each in found)


@EACH
def test_ids_need_numbers_that_the_plc_echoes(plc: str) -> None:
    text = text_of(plc)
    found = problems(plc, text[text.index("            sequence:") : text.index("            facts:")], "")
    assert any("evidence: ids needs sequence" in each for each in found), found


@pytest.mark.parametrize(("plc", "address"), [("modbus", "host"), ("opcua", "url"), ("s7", "host")])
def test_a_robot_has_no_mapping(plc: str, address: str) -> None:
    given = {address: "opc.tcp://10.0.0.7:4840" if address == "url" else "10.0.0.7"}
    arm = loader.load(None).robots["ra1"]
    assert list(PLCS[plc].settings(**given).problems(arm)) == [
        ((), "reaches devices of declared kinds; ra1 is of the kind arm")
    ]
