"""The colcon build of this package; pip builds all of Arboleda from the pyproject.toml at the root."""

from setuptools import find_packages, setup

setup(
    name="arboleda",
    version="0.1.0",
    packages=find_packages(include=["arboleda", "arboleda.*"]),
    package_data={
        "arboleda": [
            "adapters/vda5050/schemas/*.json",
            "dashboard/assets/*",
            "examples/*/*.py",
            "examples/*/*.xml",
            "examples/*/*.yaml",
            "examples/*/*/*.py",
            "examples/*/*/*.urdf",
            "plants/*.yaml",
            "playback/report/*.html",
            "py.typed",
            "starter/*",
            "web/languages/*/*.yaml",
        ]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda"]),
        ("share/arboleda", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    entry_points={
        "console_scripts": ["arboleda = arboleda.cli.entry:main"],
        "arboleda.drivers": [
            "dobot = arboleda.adapters.dobot:Dobot",
            "gcode = arboleda.adapters.gcode:Gcode",
            "modbus = arboleda.adapters.modbus:Modbus",
            "opcua = arboleda.adapters.opcua:OpcUa",
            "pylabrobot = arboleda.adapters.pylabrobot:PyLabRobot",
            "serial_arm = arboleda.adapters.serial_arm:SerialArm",
            "s7 = arboleda.adapters.s7:S7",
            "ur = arboleda.adapters.ur:Ur",
            "vda5050 = arboleda.adapters.vda5050.driver:Vda5050",
        ],
        "pytest11": ["arboleda = arboleda.testing.plugin"],
    },
)
