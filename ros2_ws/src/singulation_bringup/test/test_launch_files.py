"""Launch files against the code: executables, names on the wire, arguments. What needs ``launch`` itself is not run."""

import ast
import functools
import itertools
import re
from pathlib import Path

import pytest
from ros2_ws.src.singulation_bringup.test.launch_reading import (
    FILES,
    LAUNCH,
    Call,
    arguments,
    calls,
    description,
    nodes,
    text,
)

from singulation_bringup.commands.bring_up import parse
from singulation_perception.replay_arguments import parse_replay

SOURCE = Path(__file__).parents[2]
FOREIGN = {
    ("rviz2", "rviz2"),
    ("foxglove_bridge", "foxglove_bridge"),
    ("robot_state_publisher", "robot_state_publisher"),
}
# What launch and launch_ros of Jazzy have, as far as it is used here.
KNOWN = {
    "typing": {"Any"},
    "launch": {"LaunchDescription"},
    "launch.actions": {"DeclareLaunchArgument"},
    "launch.conditions": {"IfCondition", "UnlessCondition"},
    "launch.substitutions": {
        "AndSubstitution",
        "Command",
        "EqualsSubstitution",
        "LaunchConfiguration",
        "NotEqualsSubstitution",
        "NotSubstitution",
        "OrSubstitution",
        "PathJoinSubstitution",
        "PythonExpression",
    },
    "launch_ros.actions": {"Node"},
    "launch_ros.parameter_descriptions": {"ParameterValue"},
    "launch_ros.substitutions": {"FindPackageShare"},
}
NODE_KEYWORDS = {
    "package",
    "executable",
    "name",
    "output",
    "parameters",
    "remappings",
    "arguments",
    "ros_arguments",
    "condition",
}
every_file = pytest.mark.parametrize("path", FILES, ids=lambda path: path.name)
every_node = pytest.mark.parametrize(
    ("path", "node"),
    [
        pytest.param(path, node, id=f"{path.name}-{node.keywords['executable']}")
        for path in FILES
        for node in nodes(path)
    ],
)


def executables(package):
    setup = SOURCE / package / "setup.py"
    return set(re.findall(r'"(\w+) = [\w.]+:main"', setup.read_text())) if setup.exists() else set()


@functools.cache
def names_in_code(package):
    """Every string in the sources of a package; ``{arm}`` and ``{side}`` stand for both sides."""
    found = set()
    for path in (SOURCE / package / package).rglob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            if isinstance(node, ast.Constant) and isinstance(node.value, str):
                found.add(node.value)
            elif isinstance(node, ast.JoinedStr):
                parts = [one.value if isinstance(one, ast.Constant) else "{side}" for one in node.values]
                found |= {"".join(parts).replace("{side}", side) for side in ("left", "right")}
    return found


def test_there_are_three():
    assert [path.name for path in FILES] == ["cell.launch.py", "replay.launch.py", "sim_cell.launch.py"]
    assert LAUNCH.is_dir()


@every_file
def test_imports_are_of_jazzy_and_every_step_is_part_of_the_description(path):
    tree = ast.parse(path.read_text())
    for node in tree.body:
        if isinstance(node, ast.ImportFrom):
            assert {alias.name for alias in node.names} <= KNOWN[node.module]
        assert not isinstance(node, ast.Import)
    whole = description(path)
    assert isinstance(whole, Call)
    assert whole.name == "LaunchDescription"
    entries = whole.arguments[0]
    written = len(re.findall(r"^ *(?:return |)(?:Node|DeclareLaunchArgument)\(", path.read_text(), re.MULTILINE))
    assert len(entries) == written
    assert {one.name for one in entries} == {"Node", "DeclareLaunchArgument"}


@every_file
def test_arguments_are_documented_declared_and_used(path):
    declared = arguments(path)
    assert all(len(keywords["description"]) > 10 for keywords in declared.values())
    used = set(re.findall(r'LaunchConfiguration\("(\w+)"\)', path.read_text()))
    used |= set(re.findall(r'chosen\("\w+", "(\w+)"\)', path.read_text()))
    used |= set(re.findall(r'below\("(\w+)", ', path.read_text()))
    assert used == set(declared)
    for keywords in declared.values():
        if "choices" in keywords and isinstance(keywords.get("default_value"), str):
            assert keywords["default_value"] in keywords["choices"]
    assert path.name in path.read_text().split('"""')[1]


@every_node
def test_executables_exist(path, node):
    package, executable = node.keywords["package"], node.keywords["executable"]
    assert set(node.keywords) <= NODE_KEYWORDS
    assert node.keywords["name"] == executable
    assert executable in executables(package) or (package, executable) in FOREIGN


@every_node
def test_remapped_names_are_those_of_the_code(path, node):
    package = node.keywords["package"]
    for inside, outside in node.keywords.get("remappings", []):
        if package == "rviz2":
            continue  # its names are those of the display; test_displays.py
        if package == "robot_state_publisher":
            assert inside == "joint_states"
            continue
        assert inside in names_in_code(package)
        assert outside


@every_node
def test_command_lines_are_understood(path, node):
    defaults = {"bag": "/some/bag", "topic": "", "rate": "1.0"}
    given = [text(one) for one in node.keywords.get("arguments", [])]
    filled = [defaults[one[1:-1]] if one.startswith("{") else one for one in given]
    if node.keywords["executable"] == "bring_up":
        options = parse(filled)
        assert options.nodes
    elif node.keywords["executable"] == "replay_clouds":
        assert parse_replay(filled).wait == 300.0
    elif node.keywords["package"] in ("rviz2",):
        assert filled[0] == "-d"
        shared = filled[1].removeprefix("share:singulation_bringup/")
        assert (SOURCE / "singulation_bringup" / shared).is_file()
    else:
        assert set(filled) <= {"--autostart"}


@every_file
def test_what_is_brought_up_is_started_and_nothing_twice(path):
    started = [(one.keywords["executable"], text(one.keywords.get("condition", "always"))) for one in nodes(path)]
    assert len(started) == len(set(started))
    for node in nodes(path):
        if node.keywords["executable"] == "bring_up":
            options = parse([text(one) for one in node.keywords.get("arguments", [])])
            running = {name for name, condition in started}
            assert set(options.nodes) <= running


def test_a_dry_run_starts_nothing_that_orders_motions():
    """The executor and the coordinator hang on exactly the negation of what the dry run hangs on."""
    conditions = {one.keywords["executable"]: one.keywords.get("condition") for one in nodes(LAUNCH / "cell.launch.py")}
    assert text(conditions["dry_run"]) == "<IfCondition {dry_run}>"
    assert text(conditions["executor_node"]) == "<UnlessCondition {dry_run}>"
    assert text(conditions["singulate_node"]) == "<UnlessCondition {dry_run}>"
    assert arguments(LAUNCH / "cell.launch.py")["dry_run"]["default_value"] == "true"


def test_a_real_cell_has_no_default_place():
    declared = arguments(LAUNCH / "cell.launch.py")
    assert "default_value" not in declared["cell_file"]
    assert declared["speeds"]["default_value"] == "first_push"


def test_the_topic_of_each_camera_is_found():
    """``PythonExpression`` evaluates the joined text; the same text is evaluated here, for every choice."""
    declared = arguments(LAUNCH / "cell.launch.py")
    expression = text(declared["points"]["default_value"].arguments[0])
    for camera in declared["camera"]["choices"]:
        topic = eval(expression.replace("{camera}", camera), {"__builtins__": {}})
        assert topic.startswith("/")


@every_file
def test_expressions_can_be_evaluated(path):
    choices = {name: one.get("choices", [one.get("default_value", "x")]) for name, one in arguments(path).items()}
    for call in calls(description(path), "PythonExpression"):
        expression = text(call.arguments[0])
        names = [name for name in choices if f"{{{name}}}" in expression]
        for values in itertools.product(*(choices[name] for name in names)):
            filled = expression
            for name, value in zip(names, values, strict=True):
                filled = filled.replace(f"{{{name}}}", str(value))
            eval(filled, {"__builtins__": {}})
