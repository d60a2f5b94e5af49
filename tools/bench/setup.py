"""Build of the benchmarks, which nobody but developers installs."""

from setuptools import find_packages, setup

setup(
    name="arboleda_bench",
    version="0.1.0",
    packages=find_packages(include=["arboleda_bench", "arboleda_bench.*"]),
    package_data={"arboleda_bench": ["cost/*.json", "simulated/*.yaml"]},
    install_requires=["arboleda==0.1.0", "arboleda_drivers==0.1.0", "arboleda_proofs==0.1.0"],
    entry_points={"arboleda.bench": ["bench = arboleda_bench.command:run"]},
)
