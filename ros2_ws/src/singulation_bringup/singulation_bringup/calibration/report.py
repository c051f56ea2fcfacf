"""Calibrations and checks in words and millimetres."""

import numpy as np

from singulation_bringup.calibration.check import CheckReport
from singulation_bringup.calibration.solve import Calibration
from singulation_core.polygon import FloatArray


def calibration_text(found: Calibration) -> str:
    """What was found and how well it fits."""
    cell, table = found.cell, found.table
    height, camera = cell.table_position[2], cell.table_from_camera
    lines = [
        f"table: {len(table.residuals)} points touched, plane at z = {1e3 * height:.1f} mm in yumi_body, "
        f"{1e3 * table.lift:+.1f} mm and {np.degrees(table.tilt):.2f} degrees from before",
        f"  residuals [mm]: {_list(table.residuals)}",
        f"camera: {1e3 * camera[2, 3]:.1f} mm above the table, "
        f"{np.degrees(np.arccos(np.clip(-camera[2, 2], -1.0, 1.0))):.2f} degrees from straight down; "
        f"clouds scatter {1e3 * found.noise:.2f} mm about the table",
    ]
    for number, (shifts, heights) in enumerate(zip(found.block_residuals, found.height_residuals, strict=True), 1):
        lines.append(
            f"  cloud {number}, blocks touched against seen [mm]: "
            f"in the plane {_list(shifts)}; in height {_list(heights)}"
        )
    if len(found.block_residuals) > 1:
        lines.append(f"  from cloud to cloud the camera moves {1e3 * found.camera_spread:.2f} mm")
    lines.append(f"worst residual {1e3 * found.worst:.2f} mm")
    return "\n".join(lines)


def check_text(found: CheckReport) -> str:
    """How far the cell file is from what was measured."""
    lines = [
        f"seen table against the file: height {_list(found.offsets)} mm, "
        f"tilt {', '.join(f'{angle:.2f}' for angle in np.degrees(found.tilts))} degrees; "
        f"clouds scatter {1e3 * found.noise:.2f} mm about it"
    ]
    if len(found.table_residuals):
        lines.append(f"touched table against the file [mm]: {_list(found.table_residuals)}")
    for number, (shift, height) in enumerate(zip(found.block_residuals, found.height_residuals, strict=True), 1):
        lines.append(
            f"block {number}: seen {1e3 * shift[0]:+.2f}, {1e3 * shift[1]:+.2f} mm from where it was touched; "
            f"touched {1e3 * height:+.2f} mm above its seen top"
        )
    lines.append(f"worst difference {1e3 * found.worst:.2f} mm")
    return "\n".join(lines)


def _list(values: FloatArray) -> str:
    """Lengths [m] as millimetres."""
    return ", ".join(f"{1e3 * value:.2f}" for value in values)
