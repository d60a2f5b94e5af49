"""Build of this package, by pip."""

from setuptools import setup

setup(
    name="arboleda_ended",
    version="1.0",
    packages=["arboleda_ended"],
    package_data={"arboleda_ended": ["languages/*/*.yaml"]},
    install_requires=["arboleda"],
    entry_points={
        "arboleda.api": ["1 = arboleda_ended"],
        "arboleda.commands": ["ended = arboleda_ended.commands:COMMANDS"],
        "arboleda.languages": ["ended = arboleda_ended"],
        "arboleda.page": ["ended = arboleda_ended.page:PAGE"],
        "arboleda.parts": ["ended = arboleda_ended.part:EndedTasks"],
    },
)
