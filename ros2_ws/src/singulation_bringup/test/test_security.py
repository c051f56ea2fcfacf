"""The SROS2 policy: who may order motions, and whether every node may do what it does and nothing else.

Not tried here: keys, signatures and enforcement; Fast DDS from PyPI is built without security.
"""

import subprocess
from pathlib import Path
from xml.etree import ElementTree

import pytest
from ros2_ws.src.singulation_bringup.test.launch_reading import FILES, nodes
from ros2_ws.src.singulation_bringup.test.policy_rights import allowed, rights

from singulation_bringup.commands import status
from singulation_bringup.commands.command_node import CommandNode
from singulation_bringup.commands.overview import Overview
from singulation_bringup.dry_run.dry_run import DryRun
from singulation_bringup.reference.nodes import NODES
from singulation_bringup.singulate_node import SingulateNode
from singulation_node.testing import spinning, wait_until
from singulation_perception.perception_node import PerceptionNode
from singulation_planner.planner_node import PlannerNode
from singulation_sim.sim_cell import SimCell
from yumi_push_executor.executor_node import ExecutorNode

SECURITY = Path(__file__).parents[1] / "security"
POLICY = SECURITY / "policy.xml"
GOLDEN = Path(__file__).parent / "golden" / "permissions.txt"
KINDS = ("arm_controller/joint_trajectory", "gripper_controller/commands")
ORDERS = {f"rt/{arm}_{kind}" for arm in ("left", "right") for kind in KINDS}
RIGHTS = rights(POLICY)
ENCLAVES = sorted({right[0] for right in RIGHTS})


def test_permissions_are_the_reviewed_ones():
    """After a wanted change of the policy, review the difference and write the file anew with this test's text."""
    text = "".join(f"{' '.join(right)}\n" for right in sorted(RIGHTS))
    assert text == GOLDEN.read_text()


def test_the_executor_alone_may_order_motions():
    for topic in ORDERS:
        may = {name for name in ENCLAVES if allowed(RIGHTS, name, "publish", topic)}
        assert may == {"executor_node"}


def test_orders_are_heard_by_the_robot_only():
    for topic in ORDERS:
        may = {name for name in ENCLAVES if allowed(RIGHTS, name, "subscribe", topic)} - {"admin"}
        assert may <= {"robot_driver", "sim_cell", "smart_gripper_adapter"}


def test_the_dry_run_may_not_even_ask_for_a_motion():
    for name in ("dry_run", "planner_node", "perception_node", "status", "operate", "calibrate"):
        assert not allowed(RIGHTS, name, "publish", "rq/execute_push/_action/send_goalRequest")


def test_every_node_has_an_enclave():
    assert {node.executable for node in NODES} | {"dry_run", "replay_clouds", "bring_up"} <= set(ENCLAVES)
    for path in FILES:
        for node in nodes(path):
            if node.keywords["package"].startswith(("singulation", "yumi")):
                enclave = f"/singulation/{node.keywords['executable']}"
                assert node.keywords["ros_arguments"] == ["--enclave", enclave]
                assert enclave.rpartition("/")[2] in ENCLAVES


def test_the_policy_is_well_formed_for_sros2():
    """Elements and attributes of version 0.2.0 of the policy format."""
    root = ElementTree.parse(POLICY).getroot()
    assert root.get("version") == "0.2.0"
    verbs = {"topics": {"publish", "subscribe"}, "services": {"request", "reply"}, "actions": {"call", "execute"}}
    for tree in (root, *(ElementTree.parse(path).getroot() for path in (SECURITY / "common").glob("*.xml"))):
        for profile in tree.iter("profile"):
            for rule in profile:
                if rule.tag in verbs:
                    assert set(rule.attrib) <= verbs[rule.tag]
                    assert set(rule.attrib.values()) <= {"ALLOW", "DENY"}
                    assert {item.tag for item in rule} == {rule.tag[:-1]}
    paths = [enclave.get("path") for enclave in root.iter("enclave")]
    assert len(paths) == len(set(paths))


def used(node, name):
    """(direction, DDS topic) of all endpoints of a node, as the others see them."""
    said, heard = node.get_publisher_names_and_types_by_node, node.get_subscriber_names_and_types_by_node
    found = {("publish", f"rt{topic}") for topic, _ in said(name, "/")}
    found |= {("subscribe", f"rt{topic}") for topic, _ in heard(name, "/")}
    for service, _ in node.get_service_names_and_types_by_node(name, "/"):
        found |= {("subscribe", f"rq{service}Request"), ("publish", f"rr{service}Reply")}
    for service, _ in node.get_client_names_and_types_by_node(name, "/"):
        found |= {("publish", f"rq{service}Request"), ("subscribe", f"rr{service}Reply")}
    return found


def unused(node, name):
    """Rights that nothing of the node makes use of."""
    return {(way, topic) for enclave, _, way, topic in RIGHTS if enclave == name} - used(node, name)


NOT_ALWAYS = {  # rights that a node uses only with other parameters, other drivers, or under simulated time
    "rt/clock",
    "rt/points",
    "rt/phoxi_camera/points",
    "rt/tf",
    "rt/tf_static",
}


@pytest.mark.parametrize("node_class", [PerceptionNode, PlannerNode, ExecutorNode, SingulateNode, DryRun, SimCell])
def test_a_node_may_do_what_it_does_and_nothing_else(node_class, ros_context):
    node = node_class(context=ros_context)
    name = node.get_name()
    with spinning(node):
        assert not hasattr(node, "start") or node.start()
        # A node discovers itself as everybody else does, a little later.
        wait_until(lambda: {topic for _, topic in unused(node, name)} <= NOT_ALWAYS, what="all the rights in use")
        assert {one for one in used(node, name) if not allowed(RIGHTS, name, *one)} == set()


def test_the_status_command_may_listen(ros_context):
    with CommandNode("status", context=ros_context) as command:
        status.listen(command, Overview(status.WANTED))
        found = wait_until(lambda: used(command.node, "status"))
    assert {one for one in found if not allowed(RIGHTS, "status", *one)} == set()


def run_script(*arguments, path="/usr/bin:/bin"):
    return subprocess.run(
        [SECURITY / "make_keystore.sh", *arguments],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
        env={"PATH": path, "HOME": "/nonexistent"},
    )


def test_the_keystore_script_says_what_it_needs():
    assert run_script().returncode == 2
    missing = run_script("/nonexistent/keystore")
    assert missing.returncode == 1
    assert "source ROS 2 Jazzy" in missing.stderr


def test_the_keystore_script_asks_ros2_security_for_the_right_things(tmp_path):
    """With a program in the place of ros2 that notes what it is asked."""
    program = tmp_path / "bin" / "ros2"
    program.parent.mkdir()
    program.write_text(f'#!/bin/sh\necho "$@" >> {tmp_path}/asked\n[ "$2" = create_keystore ] && mkdir "$3"\nexit 0\n')
    program.chmod(0o755)
    store = tmp_path / "keys"
    done = run_script(str(store), path=f"{tmp_path}/bin:/usr/bin:/bin")
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "asked").read_text().splitlines() == [
        "security --help",
        f"security create_keystore {store}",
        f"security generate_artifacts -k {store} -p {POLICY}",
    ]
    assert "ROS_SECURITY_STRATEGY=Enforce" in done.stdout
    assert store.stat().st_mode & 0o077 == 0
