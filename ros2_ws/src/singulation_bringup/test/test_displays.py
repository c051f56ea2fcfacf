"""The displays show topics and frames that exist. RViz and Foxglove themselves are not started."""

import json
import re
from pathlib import Path

import pytest
import yaml
from ros2_ws.src.singulation_bringup.test.launch_reading import LAUNCH, nodes
from singulation_msgs.msg import PushOutcome

ROOT = Path(__file__).parents[4]
PACKAGE = Path(__file__).parents[1]
RVIZ = sorted((PACKAGE / "rviz").glob("*.rviz"))
FOXGLOVE = json.loads((PACKAGE / "foxglove" / "cell.json").read_text())
FRAMES = {"table", "yumi_body", "phoxi_camera_sensor"}
# Published by programs that are not ours: robot_state_publisher and every ROS node.
FOREIGN = {"/robot_description", "/rosout"}


def names_in_code():
    """Every relative or absolute name in quotes, in the sources of all packages."""
    text = "".join(path.read_text() for path in (ROOT / "ros2_ws" / "src").glob("*/[sy]*/**/*.py"))
    return {f"/{name.lstrip('/')}" for name in re.findall(r'"(/?[a-z_]+(?:/[a-z_]+)*)"', text)}


NAMES = names_in_code() | FOREIGN


def every(value, key):
    """All values of a key anywhere inside."""
    found = []
    for inside in value.values() if isinstance(value, dict) else value if isinstance(value, list) else ():
        found += every(inside, key)
    return found + ([value[key]] if isinstance(value, dict) and key in value else [])


def panels(layout):
    """Names of the panels in a tree of splits."""
    return [layout] if isinstance(layout, str) else [*panels(layout["first"]), *panels(layout["second"])]


@pytest.mark.parametrize("path", RVIZ, ids=lambda path: path.name)
def test_rviz_shows_what_is_published(path):
    content = yaml.safe_load(path.read_text())
    topics = [topic["Value"] for topic in every(content, "Topic")]
    topics += [topic["Value"] for topic in every(content, "Description Topic")]
    assert topics
    assert set(topics) <= NAMES
    frames = every(content, "Fixed Frame") + every(content, "Reference Frame") + every(content, "Target Frame")
    assert set(frames) <= FRAMES


def test_a_remapped_topic_of_rviz_is_one_it_shows():
    for path in LAUNCH.glob("*.launch.py"):
        for node in nodes(path):
            if node.keywords["package"] == "rviz2":
                shown = next(one for one in node.keywords["arguments"] if str(one).endswith(".rviz"))
                text = (PACKAGE / "rviz" / Path(shown).name).read_text()
                for inside, _ in node.keywords.get("remappings", []):
                    assert f"Value: /{inside}\n" in text


def test_every_panel_has_one_place_and_its_settings():
    placed = panels(FOXGLOVE["layout"])
    assert len(placed) == len(set(placed))
    assert set(placed) == set(FOXGLOVE["configById"])
    kinds = {"3D", "DiagnosticSummary", "Plot", "RawMessages", "RosOut", "CallService"}
    assert {name.partition("!")[0] for name in placed} <= kinds


def test_foxglove_shows_what_is_published():
    config = FOXGLOVE["configById"]
    topics = {*config["3D!cell"]["topics"], *every(config, "topic"), *every(config, "topicToRender")}
    topics |= {*every(config, "topicPath"), *every(config, "serviceName")}
    topics |= {path["value"].partition(".")[0] for path in every(config, "paths")[0]}
    assert topics <= NAMES
    assert {*every(config, "followTf"), *every(config, "frameId")} <= FRAMES


def test_plotted_fields_are_fields():
    for path in every(FOXGLOVE["configById"], "paths")[0]:
        topic, field = path["value"].split(".")
        assert topic == "/outcomes"
        assert field in PushOutcome.get_fields_and_field_types()
