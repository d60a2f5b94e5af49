"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

DRIVERS = {  # by the name in a plant file: the folder of the maker, and the class in its adapter.py
    "dobot": "dobot.adapter:Dobot",
    "follow_joint_trajectory": "joint_trajectory.adapter:FollowJointTrajectory",
    "follow_waypoints": "nav2.adapter:FollowWaypoints",
    "gcode": "gcode.adapter:Gcode",
    "gripper_command": "gripper_command.adapter:GripperCommand",
    "modbus": "modbus.adapter:Modbus",
    "mqtt": "mqtt_mapping.adapter:Mqtt",
    "navigate_to_pose": "nav2.adapter:NavigateToPose",
    "opcua": "opcua.adapter:OpcUa",
    "pylabrobot": "pylabrobot.adapter:PyLabRobot",
    "ros": "ros_mapping.adapter:RosMapping",
    "s7": "s7.adapter:S7",
    "serial_arm": "serial_arm.adapter:SerialArm",
    "ur": "ur.adapter:Ur",
    "vda5050": "vda5050.adapter:Vda5050",
}

setup(
    name="arboleda_drivers",
    version="0.1.0",
    description="Drivers of other makers' devices for Arboleda, and their virtual controllers",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"arboleda_drivers": ["languages/*/*.yaml", "py.typed", "vda5050/schemas/*.json"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_drivers"]),
        ("share/arboleda_drivers", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0", "fastjsonschema>=2.19", "websockets"],
    extras_require={
        "modbus": ["pymodbus>=3.16,<4", "pyserial>=3.5"],
        "opcua": ["asyncua>=2.1,<3"],
        # A device on a serial line (`serial_arm`, `gcode`) needs it; one behind a host and a port does not.
        "serial": ["pyserial>=3.5"],
        "s7": ["python-snap7>=3.3,<4"],
        # Whoever has a backend on USB, FTDI or HTTP adds the extra of PyLabRobot that it needs.
        "pylabrobot": ["pylabrobot>=0.2.2,<0.3"],
    },
    entry_points={
        "arboleda.commands": ["drivers = arboleda_drivers.commands:COMMANDS"],
        "arboleda.drivers": [f"{name} = arboleda_drivers.{place}" for name, place in DRIVERS.items()],
        "arboleda.languages": ["drivers = arboleda_drivers"],
    },
)
