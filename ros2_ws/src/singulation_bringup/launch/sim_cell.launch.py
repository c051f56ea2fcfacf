"""The whole suite with the simulated cell.

ros2 launch singulation_bringup sim_cell.launch.py objects:=5 seed:=1
ros2 action send_goal /singulate singulation_msgs/action/Singulate "{max_pushes: 10, min_gap: 0.012}"
"""

from typing import Any

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import (
    Command,
    LaunchConfiguration,
    OrSubstitution,
    PathJoinSubstitution,
    PythonExpression,
)
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

SHARE = FindPackageShare("singulation_bringup")
CELL = LaunchConfiguration("cell_file")
SIM_TIME = {"use_sim_time": True}


def arguments() -> list[DeclareLaunchArgument]:
    """Launch arguments, as ``ros2 launch singulation_bringup sim_cell.launch.py --show-args`` lists them."""
    return [
        DeclareLaunchArgument(
            "config",
            default_value=PathJoinSubstitution([SHARE, "config"]),
            description="folder of the parameter files; copy ours to change them",
        ),
        DeclareLaunchArgument("objects", default_value="5", description="number of blocks; 0: at random from 3 to 7"),
        DeclareLaunchArgument("seed", default_value="0", description="seed of scene and noise"),
        DeclareLaunchArgument("scene", default_value="mixed", description="kinds of blocks"),
        DeclareLaunchArgument("speed", default_value="1.0", description="simulated seconds per second"),
        DeclareLaunchArgument(
            "cell_file",
            default_value=config("cells/simulated.yaml"),
            description="where table, camera and workspace are",
        ),
        DeclareLaunchArgument(
            "autostart", default_value="true", choices=["true", "false"], description="configure and activate the nodes"
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
    """The cell and the suite; all live in the cell's time."""
    # Faster than real time, the same computing takes more of the simulated seconds.
    patience = ParameterValue(PythonExpression(["5.0 + 15.0 * ", LaunchConfiguration("speed")]), value_type=float)
    return [
        Node(
            package="singulation_sim",
            executable="sim_cell",
            name="sim_cell",
            ros_arguments=["--enclave", "/singulation/sim_cell"],
            output="screen",
            parameters=[
                config("sim_cell.yaml"),
                CELL,
                {
                    "objects": ParameterValue(LaunchConfiguration("objects"), value_type=int),
                    "seed": ParameterValue(LaunchConfiguration("seed"), value_type=int),
                    "scene": LaunchConfiguration("scene"),
                    "speed": ParameterValue(LaunchConfiguration("speed"), value_type=float),
                    "publish_clock": True,
                },
            ],
        ),
        Node(
            package="singulation_perception",
            executable="perception_node",
            name="perception_node",
            ros_arguments=["--enclave", "/singulation/perception_node"],
            output="screen",
            parameters=[config("perception_node.yaml"), CELL, SIM_TIME],
        ),
        Node(
            package="singulation_planner",
            executable="planner_node",
            name="planner_node",
            ros_arguments=["--enclave", "/singulation/planner_node"],
            output="screen",
            parameters=[config("planner_node.yaml"), CELL, SIM_TIME, {"max_age": patience}],
        ),
        Node(
            package="yumi_push_executor",
            executable="executor_node",
            name="executor_node",
            ros_arguments=["--enclave", "/singulation/executor_node"],
            output="screen",
            parameters=[config("executor_node.yaml"), CELL, SIM_TIME],
        ),
        Node(
            package="singulation_bringup",
            executable="singulate_node",
            name="singulate_node",
            ros_arguments=["--enclave", "/singulation/singulate_node"],
            output="screen",
            parameters=[config("singulate_node.yaml"), config("cameras/simulated.yaml"), SIM_TIME],
        ),
    ]


def start() -> list[Node]:
    """Configures and activates in order, and stops before the robot if the camera does not see the table."""
    return Node(
        package="singulation_bringup",
        executable="bring_up",
        name="bring_up",
        ros_arguments=["--enclave", "/singulation/bring_up"],
        output="screen",
        arguments=["--check-camera"],
        condition=IfCondition(LaunchConfiguration("autostart")),
    )


def displays() -> list[Node]:
    """RViz or Foxglove with the robot, the table and the camera in place."""
    shown = IfCondition(OrSubstitution(LaunchConfiguration("rviz"), LaunchConfiguration("foxglove")))
    urdf = PathJoinSubstitution([FindPackageShare("yumi_push_executor"), "urdf", "yumi.urdf"])
    return [
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            name="robot_state_publisher",
            parameters=[{"robot_description": ParameterValue(Command(["cat ", urdf]), value_type=str)}, SIM_TIME],
            condition=shown,
        ),
        Node(
            package="singulation_bringup",
            executable="cell_frames",
            name="cell_frames",
            ros_arguments=["--enclave", "/singulation/cell_frames"],
            arguments=["--autostart"],
            parameters=[config("cell_frames.yaml"), CELL, SIM_TIME],
            condition=shown,
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            name="rviz2",
            arguments=["-d", PathJoinSubstitution([SHARE, "rviz", "cell.rviz"])],
            parameters=[SIM_TIME],
            condition=IfCondition(LaunchConfiguration("rviz")),
        ),
        Node(
            package="foxglove_bridge",
            executable="foxglove_bridge",
            name="foxglove_bridge",
            parameters=[{"address": "127.0.0.1", "use_sim_time": True}],
            condition=IfCondition(LaunchConfiguration("foxglove")),
        ),
    ]


def generate_launch_description() -> LaunchDescription:
    """Called by ``ros2 launch``."""
    return LaunchDescription([*arguments(), *nodes(), start(), *displays()])
