"""The colcon build of this package; pip builds all of Arboleda from the pyproject.toml at the root."""

from setuptools import find_packages, setup

setup(
    name="arboleda",
    version="0.1.0",
    packages=find_packages(include=["arboleda", "arboleda.*"]),
    package_data={
        "arboleda": [
            "dashboard/assets/*",
            "dashboard/*/assets/*",
            "dashboard/*/languages/*/*.yaml",
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
