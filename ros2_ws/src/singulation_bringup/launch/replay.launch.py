"""Recorded clouds through perception and planner, without a robot.

ros2 launch singulation_bringup replay.launch.py bag:=/path/to/rosbag2
"""

from typing import Any

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.substitutions import FindPackageShare

SHARE = FindPackageShare("singulation_bringup")
CELL = LaunchConfiguration("cell_file")


def arguments() -> list[DeclareLaunchArgument]:
    """Launch arguments, as ``ros2 launch singulation_bringup replay.launch.py --show-args`` lists them."""
    return [
        DeclareLaunchArgument(
            "config",
            default_value=PathJoinSubstitution([SHARE, "config"]),
            description="folder of the parameter files; copy ours to change them",
        ),
        DeclareLaunchArgument("bag", description="rosbag2 folder, .mcap or .db3 file, or a PCD or PLY file"),
        DeclareLaunchArgument("topic", default_value="", description="topic of the bag, if several carry clouds"),
        DeclareLaunchArgument("rate", default_value="1.0", description="2 is twice as fast"),
        DeclareLaunchArgument(
            "cell_file",
            default_value=config("cells/unknown_camera.yaml"),
            description="where the camera stood; the default takes the largest plane for the table",
        ),
        DeclareLaunchArgument("rviz", default_value="false", choices=["true", "false"], description="show it in RViz"),
        DeclareLaunchArgument(
            "foxglove",
            default_value="false",
            choices=["true", "false"],
            description="serve Foxglove on ws://localhost:8765",
        ),
    ]


def config(name: str) -> list[Any]:
    """A file of the configuration."""
    return [LaunchConfiguration("config"), f"/{name}"]


def nodes() -> list[Node]:
    """Perception, planner and the recording, which waits until perception listens."""
    return [
        Node(
            package="singulation_perception",
            executable="perception_node",
            name="perception_node",
            ros_arguments=["--enclave", "/singulation/perception_node"],
            output="screen",
            parameters=[config("perception_node.yaml"), CELL],
        ),
        Node(
            package="singulation_planner",
            executable="planner_node",
            name="planner_node",
            ros_arguments=["--enclave", "/singulation/planner_node"],
            output="screen",
            parameters=[config("planner_node.yaml"), CELL],
        ),
        Node(
            package="singulation_bringup",
            executable="bring_up",
            name="bring_up",
            ros_arguments=["--enclave", "/singulation/bring_up"],
            output="screen",
            arguments=["--nodes", "planner_node", "perception_node"],
        ),
        Node(
            package="singulation_perception",
            executable="replay_clouds",
            name="replay_clouds",
            ros_arguments=["--enclave", "/singulation/replay_clouds"],
            output="screen",
            arguments=[
                LaunchConfiguration("bag"),
                "--topic",
                LaunchConfiguration("topic"),
                "--rate",
                LaunchConfiguration("rate"),
                "--wait",
                "300",
            ],
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            name="rviz2",
            arguments=["-d", PathJoinSubstitution([SHARE, "rviz", "replay.rviz"])],
            condition=IfCondition(LaunchConfiguration("rviz")),
        ),
        Node(
            package="foxglove_bridge",
            executable="foxglove_bridge",
            name="foxglove_bridge",
            parameters=[{"address": "127.0.0.1"}],
            condition=IfCondition(LaunchConfiguration("foxglove")),
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Called by ``ros2 launch``."""
    return LaunchDescription([*arguments(), *nodes()])
