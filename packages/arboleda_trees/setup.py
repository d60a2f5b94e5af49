"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

setup(
    name="arboleda_trees",
    version="0.1.0",
    description="Behavior trees as XML for Arboleda, in the form of BehaviorTree.CPP 4, and Groot2",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"arboleda_trees": ["languages/*/*.yaml", "py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_trees"]),
        ("share/arboleda_trees", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0"],
    # Who shows trees to Groot2 (`--groot2`) needs them.
    extras_require={"groot2": ["msgpack>=1", "pyzmq>=25"]},
    entry_points={
        "arboleda.checks": ["xml = arboleda_trees.checks.form_check:CHECK"],
        "arboleda.commands": ["trees = arboleda_trees.commands:COMMANDS"],
        "arboleda.extras": [
            "btlog_content = arboleda_trees.groot2.btlog:btlog",
            "check = arboleda_trees.commands.check_trees:of_trees",
            "export = arboleda_trees.bt_xml.export:export",
            "rows = arboleda_trees.commands.tree_rows:rows_of",
        ],
        "arboleda.languages": ["trees = arboleda_trees"],
        "arboleda.parts": ["trees = arboleda_trees.factories:FACTORIES"],
        "arboleda.recipes": ["xml = arboleda_trees.files.used_trees:FORM"],
    },
)
