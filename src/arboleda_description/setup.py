"""The colcon build of this package; pip builds all of Arboleda from the pyproject.toml at the root."""

from glob import glob

from setuptools import find_packages, setup

setup(
    name="arboleda_description",
    version="0.1.0",
    packages=find_packages(include=["arboleda_description", "arboleda_description.*"]),
    package_data={"arboleda_description": ["robots/*.yaml", "urdf/*.xacro"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_description"]),
        ("share/arboleda_description", ["package.xml"]),
        ("share/arboleda_description/robots", glob("arboleda_description/robots/*.yaml")),
        ("share/arboleda_description/urdf", glob("arboleda_description/urdf/*.xacro")),
    ],
    install_requires=["setuptools"],
    extras_require={"test": ["pytest"]},
)
