"""The table: blocks that move where jaws really are."""

from singulation_sim.table.jaws import FingerGeometry, Fingertip, fingertips
from singulation_sim.table.table import Contact, Table

__all__ = ["Contact", "FingerGeometry", "Fingertip", "Table", "fingertips"]
