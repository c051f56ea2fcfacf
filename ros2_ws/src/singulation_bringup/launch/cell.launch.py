"""A real cell: the suite beside the drivers of robot and camera, which are started on their own.

How to set those up: docs/robot.md, docs/camera.md.

ros2 launch singulation_bringup cell.launch.py cell_file:=my_cell.yaml                    plans and shows, moves nothing
ros2 launch singulation_bringup cell.launch.py cell_file:=my_cell.yaml dry_run:=false     the robot pushes when asked
"""

from typing import Any

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition, UnlessCondition
from launch.substitutions import (
    AndSubstitution,
    Command,
    EqualsSubstitution,
    LaunchConfiguration,
    NotEqualsSubstitution,
    NotSubstitution,
    OrSubstitution,
    PathJoinSubstitution,
    PythonExpression,
)
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

SHARE = FindPackageShare("singulation_bringup")
CELL = LaunchConfiguration("cell_file")
DRY_RUN = LaunchConfiguration("dry_run")

# Where each camera driver publishes its clouds; config/cameras has a file for each.
POINTS = {
    "phoxi_official": "/phoxi_camera/points",
    "phoxi_freerun": "/phoxi_camera/points",
    "ppi_put": "/phoxi/phoxi_camera/cloud",
    "zyadan": "/phoxi_camera/points",
}
ROBOTS = ["abb_robot_driver", "abb_yumi_ros2", "kth_yumi"]
SPEEDS = ["first_push", "slow", "full"]


def arguments() -> list[DeclareLaunchArgument]:
    """Launch arguments, as ``ros2 launch singulation_bringup cell.launch.py --show-args`` lists them."""
    points = PythonExpression([str(POINTS), "['", LaunchConfiguration("camera"), "']"])
    return [
        DeclareLaunchArgument(
            "config",
            default_value=PathJoinSubstitution([SHARE, "config"]),
            description="folder of the parameter files; copy ours to change them",
        ),
        DeclareLaunchArgument(
            "cell_file", description="where table, camera and workspace are; there is no default, calibrate writes it"
        ),
        DeclareLaunchArgument(
            "dry_run",
            default_value="true",
            choices=["true", "false"],
            description="true: plan and show motions; no program that could order one is started",
        ),
        DeclareLaunchArgument(
            "speeds", default_value="first_push", choices=SPEEDS, description="first_push pushes at 10 mm/s"
        ),
        DeclareLaunchArgument(
            "camera", default_value="phoxi_official", choices=sorted(POINTS), description="driver of the camera"
        ),
        DeclareLaunchArgument("points", default_value=points, description="topic of the camera's clouds"),
        DeclareLaunchArgument(
            "robot", default_value="abb_robot_driver", choices=ROBOTS, description="whose joint names the robot has"
        ),
        DeclareLaunchArgument("joint_states", default_value="/joint_states", description="topic of the joint states"),
        DeclareLaunchArgument(
            "left_arm", default_value="/left_arm_controller", description="the left arm's trajectory controller"
        ),
        DeclareLaunchArgument(
            "right_arm", default_value="/right_arm_controller", description="the right arm's trajectory controller"
        ),
        DeclareLaunchArgument(
            "rws",
            default_value="/rws_client",
            description='node of abb_rws_client, for the driver\'s state and the grippers; "" if you have your own',
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


def chosen(folder: str, argument: str) -> list[Any]:
    """The file of the configuration that a launch argument names."""
    return [LaunchConfiguration("config"), f"/{folder}/", LaunchConfiguration(argument), ".yaml"]


def below(argument: str, name: str) -> list[Any]:
    """A name below the one a launch argument gives."""
    return [LaunchConfiguration(argument), f"/{name}"]


def eyes() -> list[Node]:
    """Perception and planner, and the camera's trigger where it has a type of its own."""
    return [
        Node(
            package="singulation_bringup",
            executable="camera_trigger",
            name="camera_trigger",
            ros_arguments=["--enclave", "/singulation/camera_trigger"],
            output="screen",
            arguments=["--autostart"],
            parameters=[config("camera_trigger.yaml")],
            condition=IfCondition(EqualsSubstitution(LaunchConfiguration("camera"), "phoxi_official")),
        ),
        Node(
            package="singulation_perception",
            executable="perception_node",
            name="perception_node",
            ros_arguments=["--enclave", "/singulation/perception_node"],
            output="screen",
            parameters=[config("perception_node.yaml"), chosen("cameras", "camera"), CELL],
            remappings=[("points", LaunchConfiguration("points"))],
        ),
        Node(
            package="singulation_planner",
            executable="planner_node",
            name="planner_node",
            ros_arguments=["--enclave", "/singulation/planner_node"],
            output="screen",
            parameters=[config("planner_node.yaml"), CELL],
        ),
    ]


def robot() -> list[Node]:
    """What the robot's drivers say, in the suite's words; and its grippers."""
    with_rws = IfCondition(NotEqualsSubstitution(LaunchConfiguration("rws"), ""))
    services = [
        ("get_io_signal", below("rws", "get_io_signal")),
        ("set_sg_command", below("rws", "set_sg_command")),
        ("run_sg_routine", below("rws", "run_sg_routine")),
    ]
    return [
        Node(
            package="singulation_bringup",
            executable="driver_state_adapter",
            name="driver_state_adapter",
            ros_arguments=["--enclave", "/singulation/driver_state_adapter"],
            output="screen",
            arguments=["--autostart"],
            parameters=[config("driver_state_adapter.yaml"), CELL],
            remappings=[
                ("system_states", below("rws", "system_states")),
                ("runtime_states", below("rws", "sm_addin/runtime_states")),
                *services,
            ],
            condition=with_rws,
        ),
        Node(
            package="singulation_bringup",
            executable="smart_gripper_adapter",
            name="smart_gripper_adapter",
            ros_arguments=["--enclave", "/singulation/smart_gripper_adapter"],
            output="screen",
            arguments=["--autostart"],
            parameters=[config("smart_gripper_adapter.yaml"), chosen("robots", "robot"), CELL],
            remappings=[("joint_states", LaunchConfiguration("joint_states")), *services],
            condition=with_rws,
        ),
    ]


def hands() -> list[Node]:
    """Either what shows motions, or what orders them."""
    motion = [config("executor_node.yaml"), chosen("robots", "robot"), chosen("speeds", "speeds"), CELL]
    return [
        Node(
            package="singulation_bringup",
            executable="dry_run",
            name="dry_run",
            ros_arguments=["--enclave", "/singulation/dry_run"],
            output="screen",
            parameters=motion,
            remappings=[("joint_states", LaunchConfiguration("joint_states"))],
            condition=IfCondition(DRY_RUN),
        ),
        Node(
            package="yumi_push_executor",
            executable="executor_node",
            name="executor_node",
            ros_arguments=["--enclave", "/singulation/executor_node"],
            output="screen",
            parameters=motion,
            remappings=[
                ("joint_states", LaunchConfiguration("joint_states")),
                ("left_arm_controller/joint_trajectory", below("left_arm", "joint_trajectory")),
                ("right_arm_controller/joint_trajectory", below("right_arm", "joint_trajectory")),
            ],
            condition=UnlessCondition(DRY_RUN),
        ),
        Node(
            package="singulation_bringup",
            executable="singulate_node",
            name="singulate_node",
            ros_arguments=["--enclave", "/singulation/singulate_node"],
            output="screen",
            parameters=[config("singulate_node.yaml"), chosen("cameras", "camera"), CELL],
            condition=UnlessCondition(DRY_RUN),
        ),
    ]


def start() -> list[Node]:
    """Configures and activates in order, and stops before the robot if the camera does not see the table."""
    trigger = PythonExpression(["'trigger_frame' if '", LaunchConfiguration("camera"), "' == 'phoxi_official' else ''"])
    autostart = LaunchConfiguration("autostart")
    return [
        Node(
            package="singulation_bringup",
            executable="bring_up",
            name="bring_up",
            ros_arguments=["--enclave", "/singulation/bring_up"],
            output="screen",
            arguments=["--check-camera", "--trigger", trigger],
            condition=IfCondition(AndSubstitution(autostart, NotSubstitution(DRY_RUN))),
        ),
        Node(
            package="singulation_bringup",
            executable="bring_up",
            name="bring_up",
            ros_arguments=["--enclave", "/singulation/bring_up"],
            output="screen",
            arguments=["--check-camera", "--trigger", trigger, "--nodes", "perception_node", "planner_node", "dry_run"],
            condition=IfCondition(AndSubstitution(autostart, DRY_RUN)),
        ),
    ]


def displays() -> list[Node]:
    """RViz or Foxglove with the robot, the table and the camera in place."""
    shown = IfCondition(OrSubstitution(LaunchConfiguration("rviz"), LaunchConfiguration("foxglove")))
    urdf = PathJoinSubstitution([FindPackageShare("yumi_push_executor"), "urdf", "yumi.urdf"])
    return [
        Node(
            package="robot_state_publisher",
            executable="robot_state_publisher",
            name="robot_state_publisher",
            parameters=[{"robot_description": ParameterValue(Command(["cat ", urdf]), value_type=str)}],
            remappings=[("joint_states", LaunchConfiguration("joint_states"))],
            condition=shown,
        ),
        Node(
            package="singulation_bringup",
            executable="cell_frames",
            name="cell_frames",
            ros_arguments=["--enclave", "/singulation/cell_frames"],
            arguments=["--autostart"],
            parameters=[config("cell_frames.yaml"), CELL],
            condition=shown,
        ),
        Node(
            package="rviz2",
            executable="rviz2",
            name="rviz2",
            arguments=["-d", PathJoinSubstitution([SHARE, "rviz", "cell.rviz"])],
            remappings=[("points", LaunchConfiguration("points"))],
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
    return LaunchDescription([*arguments(), *eyes(), *robot(), *hands(), *start(), *displays()])
