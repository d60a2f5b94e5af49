"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

setup(
    name="arboleda_proofs",
    version="0.1.0",
    description="Simulator with truth, proofs, replay and forks of records for Arboleda",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={
        "arboleda_proofs": [
            "languages/*/*.yaml",
            "page/assets/*",
            "past/assets/*",
            "playback/report/*.html",
            "py.typed",
        ]
    },
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_proofs"]),
        ("share/arboleda_proofs", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0"],
    extras_require={
        # Runs on the workers of other hosts (`--on`) need it.
        "cluster": ["distributed>=2026.8"],
    },
    entry_points={
        "arboleda.client": ["proofs = arboleda_proofs.client:ProofsRoutes"],
        "arboleda.commands": ["proofs = arboleda_proofs.commands:COMMANDS"],
        "arboleda.extras": [
            "btlog = arboleda_proofs.playback.btlog_export:write",
            "case = arboleda_proofs.commands.record_case:export",
        ],
        "arboleda.languages": ["proofs = arboleda_proofs"],
        "arboleda.page": [
            "proofs = arboleda_proofs.page.page_part:PAGE",
            "proofs.past = arboleda_proofs.past.page_part:PAGE",
        ],
        "arboleda.parts": ["proofs = arboleda_proofs.running.factories:FACTORIES"],
        "arboleda.routes": [
            "proofs.faults = arboleda_proofs.routes.faults:routes",
            "proofs.reports = arboleda_proofs.routes.reports:routes",
        ],
        "pytest11": ["arboleda = arboleda_proofs.testing.plugin"],
    },
)
