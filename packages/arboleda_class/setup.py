"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

setup(
    name="arboleda_class",
    version="0.1.0",
    description="Playground, exercises and notebooks for a class on Arboleda",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={
        "arboleda_class": [
            "exercises/catalog/*/*.yaml",
            "exercises/catalog/*/start/*",
            "languages/*/*.yaml",
            "playground/static/*",
            "py.typed",
        ]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_class"]),
        ("share/arboleda_class", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0", "arboleda_proofs==0.1.0", "arboleda_trees==0.1.0"],
    entry_points={
        "arboleda.commands": ["class = arboleda_class.commands:COMMANDS"],
        "arboleda.languages": ["class = arboleda_class"],
    },
)
