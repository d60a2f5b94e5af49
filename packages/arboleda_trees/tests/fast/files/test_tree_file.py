"""Files of trees on the command line."""

from __future__ import annotations

from pathlib import Path

import pytest
from typer.testing import CliRunner, Result

from arboleda.cli.main import cli
from arboleda.model.errors import ConfigError

GOOD = """<root BTCPP_format="4" main_tree_to_execute="Main">
<include path="parts/load.xml"/>
<BehaviorTree ID="Main"><Sequence><SubTree ID="Load"/><Zap/><ScriptCondition code="a && b"/></Sequence>
</BehaviorTree></root>"""
LOAD = '<root BTCPP_format="4"><BehaviorTree ID="Load"><Action ID="Grip"/></BehaviorTree></root>'


@pytest.fixture
def file(tmp_path: Path) -> Path:
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts/load.xml").write_text(LOAD)
    path = tmp_path / "tend.XML"
    path.write_text(GOOD)
    return path


def run(*words: object) -> Result:
    return CliRunner().invoke(cli, [str(word) for word in words])


def test_a_good_file_is_told_with_its_warnings_and_the_leaves_that_nobody_knows(file: Path) -> None:
    said = run("check", file)
    assert said.exit_code == 0
    lines = said.output.splitlines()
    assert lines[0].startswith(f"{file}:3:78: warning: the variable 'a' is read")
    assert lines[-2:] == [
        f"{file}: note: 2 kinds of leaves, which a plant or a program has to bring: Grip, Zap",
        f"{file}: good: 5 nodes; trees Load, Main",
    ]


def test_a_project_of_groot2_is_read_with_the_files_that_it_names(file: Path) -> None:
    project = file.with_name("Project.btproj")
    model = '<TreeNodesModel><Action ID="Zap"/></TreeNodesModel>'
    project.write_text(f'<root BTCPP_format="4" project_name="P"><include path="{file.name}"/>{model}</root>')
    said = run("check", project)
    assert said.exit_code == 0 and said.output.endswith(f"{project}: good: 5 nodes; trees Load, Main\n")
    assert "Sequence" in run("tree", file).output


def test_mistakes_are_told_all_at_once_those_of_included_files_too(file: Path) -> None:
    file.write_text(GOOD.replace("<Zap/>", "<Inverter/>"))
    load = file.parent / "parts/load.xml"
    load.write_text(LOAD.replace("<Action ID", "<Action id"))
    refused = run("check", file).exception
    assert isinstance(refused, ConfigError)
    first, second, *_ = refused.problems
    assert first.startswith(f"{load}:1:48: which?") and second.startswith(f"{file}:3:55: Inverter")


@pytest.mark.parametrize(
    ("content", "words"), [(b"<!DOCTYPE x><root/>", "refused; delete it"), (b"cells:", "begins with a tag")]
)
def test_what_is_no_file_of_trees_is_refused(content: bytes, words: str, tmp_path: Path) -> None:
    path = tmp_path / "x.xml"
    path.write_bytes(content)
    assert words in str(run("check", path).exception)


def test_a_file_that_is_not_there_is_told(tmp_path: Path) -> None:
    assert "no such file" in str(run("check", tmp_path / "no.xml").exception)
    (tmp_path / "a.xml").write_text('<root><include path="&#9;"/></root>')
    assert "no such file" in str(run("check", tmp_path / "a.xml").exception)


@pytest.mark.parametrize("format", ["ascii", "svg", "dot"])
def test_a_tree_of_a_file_is_drawn_with_its_subtrees(file: Path, format: str) -> None:
    drawn = run("tree", file, "--format", format)
    assert drawn.exit_code == 0
    assert all(word in drawn.output for word in ("Sequence", "Load", "Grip", "Zap"))


def test_of_several_trees_one_has_to_be_the_main_one(file: Path) -> None:
    file.write_text(GOOD.replace(' main_tree_to_execute="Main"', ""))
    refused = run("tree", file).exception
    assert isinstance(refused, ConfigError) and "which tree?" in str(refused) and "Load, Main" in str(refused)


@pytest.fixture
def sourced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """The folder of what a ROS package `pick` shares, where ROS 2 is sourced."""
    first, second = tmp_path / "first", tmp_path / "second"
    (first / "share/ament_index/resource_index/packages").mkdir(parents=True)
    packages = second / "share/ament_index/resource_index/packages"
    packages.mkdir(parents=True)
    (packages / "pick").touch()
    (second / "share/pick").mkdir()
    (second / "share/pick/load.xml").write_text(LOAD)
    monkeypatch.setenv("AMENT_PREFIX_PATH", f"{first}:{second}")
    return second / "share/pick"


IN_PACKAGE = GOOD.replace('path="parts/load.xml"', 'ros_pkg="pick" path="load.xml"')


def test_what_lies_in_a_ros_package_is_found_where_that_is_sourced(file: Path, sourced: Path) -> None:
    file.write_text(IN_PACKAGE)
    assert run("check", file).output.splitlines()[-1] == f"{file}: good: 5 nodes; trees Load, Main"
    (sourced / "load.xml").write_text(LOAD.replace("Action ID", "Action id"))
    assert f"{sourced / 'load.xml'}:1:48: which?" in str(run("check", file).exception)
    (sourced / "load.xml").unlink()
    assert f"{file}:2:25: {sourced / 'load.xml'}: there is no such file" in str(run("check", file).exception)


@pytest.mark.parametrize("package", ["place", "../pick", "pick/.."])
def test_a_package_that_is_not_there_is_said_and_its_trees_are_not_missed(
    file: Path, sourced: Path, package: str
) -> None:
    file.write_text(IN_PACKAGE.replace('ros_pkg="pick"', f'ros_pkg="{package}"'))
    said = run("check", file)
    assert said.exit_code == 0
    assert f"the ROS package '{package}', which is not among those that are sourced here" in said.output
    assert "is in none of these files" not in said.output


def test_where_no_ros_is_sourced_that_is_said(file: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("AMENT_PREFIX_PATH", raising=False)
    file.write_text(IN_PACKAGE)
    assert run("check", file).output.splitlines()[0] == (
        f"{file}:2:25: warning: 'load.xml' lies in the ROS package 'pick', which cannot be found: "
        "no ROS 2 is sourced here; it was not looked into; name it by its path from this file to have it read"
    )


@pytest.mark.parametrize("package", ["", 'ros_pkg="pick" '])
def test_an_absolute_path_counts_where_it_leads_to_a_file(file: Path, package: str) -> None:
    there = file.parent / "parts/load.xml"
    file.write_text(GOOD.replace('path="parts/load.xml"', f'{package}path="{there}"'))
    assert run("check", file).output.splitlines()[-1] == f"{file}: good: 5 nodes; trees Load, Main"
    there.unlink()
    said = run("check", file)
    assert said.exit_code == 0 and "is an absolute path, and there is no such file here" in said.output
    assert "'Load' is in none of these files" not in said.output
