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
        "arboleda.extras": ["ros_log = arboleda_ros.record_log:RosLog"],
        "arboleda.links": ["ros = arboleda_ros.link:connect"],
        "console_scripts": [
            "orchestrator = arboleda_ros.nodes:orchestrator",
            "mqtt_bridge = arboleda_ros.nodes:mqtt_bridge",
            "virtual_devices = arboleda_ros.nodes:virtual_devices",
        ],
    },
)
