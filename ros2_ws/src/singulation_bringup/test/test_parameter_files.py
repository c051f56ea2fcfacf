"""Every parameter file is accepted by the nodes that load it, in the order in which the launch files name it."""

import itertools
import re
from pathlib import Path

import pytest
import rclpy
import yaml
from rclpy.node import Node
from ros2_ws.src.singulation_bringup.test.launch_reading import FILES, arguments, nodes, text

from singulation_bringup.reference.__main__ import stale_files
from singulation_bringup.reference.nodes import NODES
from singulation_core import CellGeometry, InvalidInputError
from singulation_node.domain import reserved_domain
from singulation_node.parameters import ParameterSet
from yumi_push_executor.executor_settings import ExecutorSettings

ROOT = Path(__file__).parents[4]
PACKAGE = Path(__file__).parents[1]
CONFIG = PACKAGE / "config"
SETTINGS = {node.executable: node.settings for node in NODES} | {"dry_run": ExecutorSettings}
COMMON = {"use_sim_time", "autostart"}


def values(path):
    content = yaml.safe_load(path.read_text())
    assert list(content) == ["/**"]
    assert list(content["/**"]) == ["ros__parameters"]
    return content["/**"]["ros__parameters"]


def names_of(executable):
    return set(SETTINGS[executable].__dataclass_fields__)


def chains():
    """Every list of files that some node may be started with: launch file, executable, files in order."""
    for path in FILES:
        declared = arguments(path)
        for node in nodes(path):
            given = [one for one in node.keywords.get("parameters", []) if not isinstance(one, dict)]
            if node.keywords["executable"] not in SETTINGS or not given:
                continue
            choices = {name: keywords["choices"] for name, keywords in declared.items() if "choices" in keywords}
            choices["cell_file"] = [_default_cell(declared)]
            used = sorted(name for name in choices if any(f"{{{name}}}" in text(one) for one in given))
            for combination in itertools.product(*(choices[name] for name in used)):
                files = [_filled(text(one), dict(zip(used, combination, strict=True))) for one in given]
                yield path.name, node.keywords["executable"], tuple(files)


def _default_cell(declared):
    default = declared["cell_file"].get("default_value")
    return text(default) if default else "{config}/cells/simulated.yaml"


def _filled(pattern, chosen):
    for name, value in chosen.items():
        pattern = pattern.replace(f"{{{name}}}", value)
    return pattern.replace("{config}", str(CONFIG))


CHAINS = sorted(set(chains()))


def settings_from(context, executable, files):
    options = [item for path in files for item in ("--params-file", str(path))]
    node = Node(executable, context=context, cli_args=["--ros-args", *options], use_global_arguments=False)
    try:
        return ParameterSet(node, SETTINGS[executable]).current
    finally:
        node.destroy_node()


@pytest.fixture(scope="module")
def context():
    context = rclpy.Context()
    with reserved_domain() as domain:
        rclpy.init(context=context, domain_id=domain)
        yield context
        context.try_shutdown()


def test_files_and_pages_are_those_of_the_code():
    assert stale_files(ROOT) == [], "run: scripts/docs"


@pytest.mark.parametrize("node", NODES, ids=lambda node: node.executable)
def test_the_file_of_a_node_names_all_its_parameters_at_their_defaults(node, context):
    path = CONFIG / f"{node.executable}.yaml"
    lines = re.findall(r"^    (?:# \(set in \w+/\*\.yaml\) )?(\w+): (.*)$", path.read_text(), re.MULTILINE)
    assert [name for name, _ in lines if name != "autostart"] == list(node.settings.__dataclass_fields__)
    for name, value in lines:
        default = getattr(node.settings(), name, False)
        assert yaml.safe_load(value) == (list(default) if isinstance(default, tuple) else default)
    assert settings_from(context, node.executable, [path]) == node.settings()


@pytest.mark.parametrize(("launch", "executable", "files"), CHAINS, ids=lambda value: Path(str(value)).name[-40:])
def test_the_files_of_a_launch_are_accepted_and_all_their_values_arrive(launch, executable, files, context):
    found = settings_from(context, executable, files)
    wanted = [(name, value) for path in files for name, value in values(Path(path)).items()]
    wanted = [(name, value) for name, value in wanted if name in names_of(executable)]
    assert len({name for name, _ in wanted}) == len(wanted), "a parameter stands in two files"
    for name, value in wanted:
        assert getattr(found, name) == (tuple(value) if isinstance(value, list) else value)


def test_why_no_parameter_may_stand_in_two_files(context, tmp_path):
    """A known limit of rcl in Jazzy: of two types given to one parameter it keeps one, whichever came later."""
    first, second = tmp_path / "first.yaml", tmp_path / "second.yaml"
    first.write_text("/**:\n  ros__parameters:\n    push_speed: 0.05\n")
    second.write_text("/**:\n  ros__parameters:\n    push_speed: fast\n")
    assert settings_from(context, "executor_node", [first, second]).push_speed == 0.05
    with pytest.raises(InvalidInputError, match="push_speed"):
        settings_from(context, "executor_node", [second])


@pytest.mark.parametrize("path", sorted(CONFIG.glob("*/*.yaml")), ids=lambda path: f"{path.parent.name}-{path.stem}")
def test_every_key_is_a_parameter_of_a_node_that_loads_the_file(path):
    loading = {executable for _, executable, files in CHAINS if str(path) in files}
    assert loading, f"no launch file names {path.name}"
    known = set().union(*(names_of(executable) for executable in loading))
    assert set(values(path)) <= known


@pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
def test_values_in_launch_files_are_parameters(path):
    for node in nodes(path):
        if node.keywords["executable"] not in SETTINGS:
            continue
        for given in node.keywords.get("parameters", []):
            if isinstance(given, dict):
                assert set(given) <= names_of(node.keywords["executable"]) | COMMON


def test_choices_have_files_and_files_are_choices():
    declared = arguments(FILES[0])
    for argument, folder in (("camera", "cameras"), ("robot", "robots"), ("speeds", "speeds")):
        found = {path.stem for path in (CONFIG / folder).glob("*.yaml")} - {"simulated"}
        assert set(declared[argument]["choices"]) == found


def test_the_simulated_cell_is_where_the_code_has_it():
    assert values(CONFIG / "cells" / "simulated.yaml") == {
        name: list(getattr(CellGeometry(), name)) for name in CellGeometry.__dataclass_fields__
    }


def test_full_speed_is_the_default_and_the_first_push_is_slow():
    default = ExecutorSettings()
    full, first = values(CONFIG / "speeds" / "full.yaml"), values(CONFIG / "speeds" / "first_push.yaml")
    assert full == {name: getattr(default, name) for name in full}
    assert first["push_speed"] == 0.010
    assert set(first) == set(full)


@pytest.mark.parametrize(
    ("line", "word"),
    [
        ("push_speed: 50.0", "push_speed"),
        ("push_speed: fast", "push_speed"),
        ("push_speed: 1", "push_speed"),
        ("push_speed: .nan", "push_speed"),
        ("arms: third", "arms"),
        ("left_arm_joints: [a, b]", "left"),
    ],
)
def test_a_wrong_value_is_refused_by_name(line, word, context, tmp_path):
    wrong = tmp_path / "wrong.yaml"
    wrong.write_text(f"/**:\n  ros__parameters:\n    {line}\n")
    with pytest.raises(InvalidInputError, match=word):
        settings_from(context, "executor_node", [wrong])
    assert settings_from(context, "executor_node", [CONFIG / "executor_node.yaml"]) == ExecutorSettings()
