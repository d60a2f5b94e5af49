"""Build of this package, by pip and by colcon."""

from setuptools import find_packages, setup

setup(
    name="arboleda_fleet",
    version="0.1.0",
    description="Several hosts and many plants for Arboleda: standby, PostgreSQL, one page, OEE, OPC UA",
    license="Apache-2.0",
    python_requires=">=3.10",
    package_dir={"": "src"},
    packages=find_packages("src"),
    package_data={"arboleda_fleet": ["languages/*/*.yaml", "page/assets/*", "py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", ["resource/arboleda_fleet"]),
        ("share/arboleda_fleet", ["package.xml"]),
    ],
    install_requires=["arboleda==0.1.0"],
    extras_require={
        # A memory in PostgreSQL (`store:`) needs it; a file does not.
        "postgres": ["psycopg[binary]>=3.2"],
        # The plant as a server of OPC UA (`opcua_view:`) needs it.
        "opcua": ["asyncua>=2.1,<3"],
    },
    entry_points={
        "arboleda.client": ["fleet = arboleda_fleet.client:FleetRoutes"],
        "arboleda.commands": ["fleet = arboleda_fleet.commands:COMMANDS"],
        "arboleda.languages": ["fleet = arboleda_fleet"],
        "arboleda.page": ["fleet = arboleda_fleet.page.page_part:PAGE"],
        "arboleda.parts": ["fleet = arboleda_fleet.factories:FACTORIES"],
        "arboleda.routes": ["fleet.oee = arboleda_fleet.oee.routes:routes"],
        "arboleda.standby": ["fleet = arboleda_fleet.standby.process:take_over"],
        "arboleda.stores": [
            f"{scheme} = arboleda_fleet.postgres.databases:Postgres" for scheme in ("postgres", "postgresql")
        ],
    },
)
