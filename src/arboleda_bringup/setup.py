"""The colcon build of this package; it is no part of the pip distribution."""

from setuptools import find_packages, setup

setup(
    name="arboleda_bringup",
    version="0.1.0",
    packages=find_packages(include=["arboleda_bringup", "arboleda_bringup.*"]),
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_bringup"]),
        ("share/arboleda_bringup", ["package.xml"]),
        ("share/arboleda_bringup/launch", ["launch/plant.launch.py"]),
        ("share/arboleda_bringup/rviz", ["rviz/plant.rviz"]),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
)
