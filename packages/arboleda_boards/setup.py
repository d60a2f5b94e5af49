"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

setup(
    name="arboleda_boards",
    version="0.1.0",
    description="Conformance kit for the boards of Arboleda's devices, and the header of their firmware",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"arboleda_boards": ["languages/*/*.yaml", "py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_boards"]),
        ("share/arboleda_boards", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0"],
    entry_points={
        "arboleda.commands": ["boards = arboleda_boards.commands:COMMANDS"],
        "arboleda.languages": ["boards = arboleda_boards"],
        "arboleda.parts": ["boards = arboleda_boards.linux_boards:FACTORIES"],
    },
)
