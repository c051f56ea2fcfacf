"""The whole chain in one process, without ROS: camera, perception, planner, motion, supervision, robot, table."""

from singulation_bringup.closed_loop.library_cell import LibraryCell
from singulation_bringup.closed_loop.setting import CellSetting
from singulation_bringup.closed_loop.supervised_robot import SupervisedRobot

__all__ = ["CellSetting", "LibraryCell", "SupervisedRobot"]
