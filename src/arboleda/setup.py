"""The colcon build of this package; pip builds all of Arboleda from the pyproject.toml at the root."""

import sys

from setuptools import find_packages, setup

if {"bdist_wheel", "dist_info", "editable_wheel", "sdist"}.intersection(sys.argv):
    raise SystemExit(
        "src/arboleda is built by colcon alone: its wheel would have Arboleda's name, and no libraries. "
        "Give pip the folder above src, where pyproject.toml is."
    )

setup(
    name="arboleda",
    version="0.1.0",
    packages=find_packages(include=["arboleda", "arboleda.*"]),
    package_data={
        "arboleda": [
            "dashboard/assets/*",
            "dashboard/*/assets/*",
            "dashboard/*/languages/*/*.yaml",
            "examples/*/*.json",
            "examples/*/*.py",
            "examples/*/*.xml",
            "examples/*/*.yaml",
            "examples/*/*/*.py",
            "examples/*/*/*.urdf",
            "examples/*/*/*/*/*.yaml",
            "plants/*.yaml",
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
    },
)
