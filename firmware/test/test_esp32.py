"""The ESP32 port's project file: what it names is there, and each library with its licence."""

from __future__ import annotations

import re
from configparser import ConfigParser
from pathlib import Path

import pytest

PORT = Path(__file__).parents[1] / "esp32"
TEXT = (PORT / "platformio.ini").read_text(encoding="ascii")


@pytest.fixture
def project() -> ConfigParser:
    parsed = ConfigParser(interpolation=None, strict=True)
    parsed.read_string(TEXT)
    return parsed


def test_every_library_has_a_version_and_a_licence(project: ConfigParser) -> None:
    libraries = project["env"]["lib_deps"].split("\n")[1:]
    assert libraries
    for library in libraries:
        name = re.fullmatch(r"\w+/(\w+) @ ~\d+\.\d+\.\d+", library)
        assert name, f"{library} is not OWNER/NAME @ ~VERSION"
        assert re.search(rf"^; {name[1]} +(MIT|Apache-2\.0|BSD-\S+) ", TEXT, re.MULTILINE)


def test_no_library_is_under_the_gpl() -> None:
    assert not re.search(r"\b(?<!L)GPL|AccelStepper|PubSubClient", TEXT)


def test_the_core_is_built_with_the_ramps_flags(project: ConfigParser) -> None:
    env = project["env"]
    assert {"-std=gnu++17", "-ffp-contract=off", "-I../core", "-Isrc"} <= set(env["build_flags"].split())
    assert "+<core/*.cpp>" in env["build_src_filter"].split()
    assert list((PORT / project["platformio"]["src_dir"] / "core").glob("*.cpp"))


def test_no_environment_builds_a_source_beyond_the_folder_of_sources(project: ConfigParser) -> None:
    # PlatformIO puts an object at .pio/build/ENVIRONMENT/src/ and the path of its source from src_dir.
    filters = [env["build_src_filter"] for env in project.values() if "build_src_filter" in env]
    assert len(filters) == 2
    for patterns in filters:
        assert ".." not in patterns
        for pattern in patterns.split():
            assert list((PORT / project["platformio"]["src_dir"]).glob(pattern[2:-1])), pattern


def test_the_default_environment_is_one_of_the_file(project: ConfigParser) -> None:
    assert f"env:{project['platformio']['default_envs']}" in project.sections()


@pytest.mark.parametrize("name", ["device", "device-tls"])
def test_a_declared_device_is_built_from_its_own_sources_and_no_arm(name: str, project: ConfigParser) -> None:
    env = project[f"env:{name}"]
    assert "-DARBOLEDA_DEVICE" in (project["env:device"]["build_flags"] + env["build_flags"]).split()
    sources = project["env:device"]["build_src_filter"].split()
    assert {"-<esp32/src/motion.cpp>", "-<esp32/src/machine.cpp>", "+<core/*.cpp>"} <= set(sources)
    assert "-<esp32/src/device_*.cpp>" in project["env"]["build_src_filter"].split()
    assert {"device_motion.cpp", "device_machine.cpp"} <= {path.name for path in (PORT / "src").iterdir()}
