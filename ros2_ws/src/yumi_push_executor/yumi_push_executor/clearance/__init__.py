"""What the robot must stay clear of: itself, its other arm, the table, the blocks, the camera's view."""

from yumi_push_executor.clearance.checker import Checker, Contact, Stage
from yumi_push_executor.clearance.scene import Margins, Scene, build_scene
from yumi_push_executor.clearance.view import FIELD_OF_VIEW, parts_in_view

__all__ = ["FIELD_OF_VIEW", "Checker", "Contact", "Margins", "Scene", "Stage", "build_scene", "parts_in_view"]
