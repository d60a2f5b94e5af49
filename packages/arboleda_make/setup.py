"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

setup(
    name="arboleda_make",
    version="0.1.0",
    description="Changing a plant of Arboleda: drafts, versions, teaching, tries, proposals of assistants",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"arboleda_make": ["languages/*/*.yaml", "page/assets/*", "py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_make"]),
        ("share/arboleda_make", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0", "arboleda_proofs==0.1.0", "arboleda_trees==0.1.0"],
    extras_require={"mcp": ["mcp>=2.3,<3"]},  # assistants (`arboleda mcp`)
    entry_points={
        "arboleda.client": ["make = arboleda_make.client.methods:MakeRoutes"],
        "arboleda.commands": ["make = arboleda_make.commands:COMMANDS"],
        "arboleda.extras": [
            "mend = arboleda_make.mending.search:mend_of",
            "notice = arboleda_make.mending.noticing:noticing_mend",
        ],
        "arboleda.languages": ["make = arboleda_make"],
        "arboleda.page": ["make = arboleda_make.page.page_part:PAGE"],
        "arboleda.parts": ["make = arboleda_make.factories:FACTORIES"],
        "arboleda.routes": [
            "make.draft = arboleda_make.routes.draft:routes",
            "make.make = arboleda_make.routes.make:routes",
            "make.proposals = arboleda_make.routes.proposals:routes",
            "make.teach = arboleda_make.routes.teach:routes",
            "make.trees = arboleda_make.routes.trees:routes",
            "make.versions = arboleda_make.routes.versions:routes",
        ],
    },
)
