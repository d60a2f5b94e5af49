"""The colcon build of this package; pip builds all of Arboleda from the pyproject.toml at the root."""

from setuptools import find_packages, setup

setup(
    name="arboleda_ros",
    version="0.1.0",
    packages=find_packages(include=["arboleda_ros", "arboleda_ros.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_ros"]),
        ("share/arboleda_ros", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
    entry_points={
        "arboleda.drivers": [
            "follow_joint_trajectory = arboleda_ros.joint_trajectory:FollowJointTrajectory",
            "follow_waypoints = arboleda_ros.nav2:FollowWaypoints",
            "gripper_command = arboleda_ros.gripper_command:GripperCommand",
            "navigate_to_pose = arboleda_ros.nav2:NavigateToPose",
        ],
        "arboleda.links": ["ros = arboleda_ros.link:connect"],
        "arboleda.virtual": [
            "gripper = arboleda_ros.virtual.gripper:controller",
            "nav2 = arboleda_ros.virtual.nav2:controller",
            "trajectory = arboleda_ros.virtual.trajectory:controller",
        ],
        "console_scripts": [
            "orchestrator = arboleda_ros.nodes:orchestrator",
            "mqtt_bridge = arboleda_ros.nodes:mqtt_bridge",
            "virtual_devices = arboleda_ros.nodes:virtual_devices",
        ],
    },
)
