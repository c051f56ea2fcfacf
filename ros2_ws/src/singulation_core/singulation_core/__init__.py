"""Vocabulary of planar singulation: objects, arrangements, pushes and how far apart things are."""

from singulation_core.arrangement import Arrangement
from singulation_core.cell import CellGeometry
from singulation_core.contact_mode import ContactMode, contact_mode
from singulation_core.errors import InvalidInputError, SingulationError
from singulation_core.planar_object import PlanarObject
from singulation_core.push import Push, PusherGeometry
from singulation_core.result_code import ResultCode
from singulation_core.singulation_distance import singulation_distance, smallest_gap

__all__ = [
    "Arrangement",
    "CellGeometry",
    "ContactMode",
    "InvalidInputError",
    "PlanarObject",
    "Push",
    "PusherGeometry",
    "ResultCode",
    "SingulationError",
    "contact_mode",
    "singulation_distance",
    "smallest_gap",
]
