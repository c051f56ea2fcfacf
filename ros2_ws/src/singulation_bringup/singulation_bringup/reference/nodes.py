"""Every node of the suite that has parameters, and the class that declares them."""

from dataclasses import dataclass
from typing import Any

from singulation_bringup.adapters.camera_trigger_settings import CameraTriggerSettings
from singulation_bringup.adapters.cell_frames_settings import CellFramesSettings
from singulation_bringup.adapters.driver_state_settings import DriverStateSettings
from singulation_bringup.adapters.smart_gripper_settings import SmartGripperSettings
from singulation_bringup.singulate_node import SingulateSettings
from singulation_perception.perception_settings import PerceptionSettings
from singulation_planner.planner_settings import PlannerSettings
from singulation_sim.sim_settings import SimSettings
from yumi_push_executor.executor_settings import ExecutorSettings


@dataclass(frozen=True, slots=True)
class NodeEntry:
    """A node.

    Args:
        package: that it is in.
        executable: as given to ``ros2 run``; also its name and that of its parameter file.
        settings: frozen dataclass of its parameters.
        lifecycle: whether it has to be configured and activated.
    """

    package: str
    executable: str
    settings: type[Any]
    lifecycle: bool


# Parameters that the launch files take from a file of a group, shared by several nodes. rcl does not replace a value by
# one of another type from a later file, it silently keeps one of the two; so no parameter stands in two files.
GROUPS = {
    "cells": (
        "table_position",
        "table_quaternion",
        "workspace",
        "camera_position",
        "camera_quaternion",
        "camera_pose_source",
        "crop_to_workspace",
    ),
    "cameras": ("trigger_service", "view_delay", "quiet_after"),
    "robots": ("left_arm_joints", "right_arm_joints", "left_finger_joint", "right_finger_joint"),
    "speeds": ("approach_speed", "vertical_speed", "push_speed"),
}

NODES = (
    NodeEntry("singulation_perception", "perception_node", PerceptionSettings, True),
    NodeEntry("singulation_planner", "planner_node", PlannerSettings, True),
    NodeEntry("yumi_push_executor", "executor_node", ExecutorSettings, True),
    NodeEntry("singulation_bringup", "singulate_node", SingulateSettings, True),
    NodeEntry("singulation_sim", "sim_cell", SimSettings, False),
    NodeEntry("singulation_bringup", "driver_state_adapter", DriverStateSettings, True),
    NodeEntry("singulation_bringup", "smart_gripper_adapter", SmartGripperSettings, True),
    NodeEntry("singulation_bringup", "camera_trigger", CameraTriggerSettings, True),
    NodeEntry("singulation_bringup", "cell_frames", CellFramesSettings, True),
)
