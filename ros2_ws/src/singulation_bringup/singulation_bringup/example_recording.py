"""Makes the small recording that the repository ships: ``python -m singulation_bringup.example_recording FOLDER``.

Three scenes of blocks before the simulated camera at a quarter of the PhoXi's image size, so that the bag stays small.
"""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray
from std_msgs.msg import Header

from singulation_core import CellGeometry, SingulationError, conversions
from singulation_perception.bag_writing import BagRecorder
from singulation_sim.camera import CameraModel, PhoxiCamera
from singulation_sim.scenes import random_scene

SCENES = ((1, 3), (2, 5), (3, 7))  # seed, blocks
TOPIC = "/points"
_MODEL = CameraModel(width=516, height=386, focal=561.0, centre=(255.5, 192.75))
# Coordinates in steps of 15 micrometres, far below the noise: what is left of the numbers compresses well.
_STEP = 2.0**-16
_PERIOD = 2.0  # s between clouds
_BEGIN = 1_700_000_000.0  # s; a fixed date, so that the same program makes the same bag


def clouds() -> list[NDArray[np.float32]]:
    """(H, W, 3) clouds of the scenes [m], camera frame."""
    taken = []
    for seed, blocks in SCENES:
        camera = PhoxiCamera(CellGeometry(), _MODEL, seed=seed)
        cloud = camera.capture(random_scene("mixed", blocks, seed))
        taken.append((np.round(cloud / _STEP) * _STEP).astype(np.float32))
    return taken


def record(folder: Path) -> None:
    """Write the bag.

    Raises:
        SingulationError: ``BAD_FILE`` if the folder exists or cannot be made.
    """
    with BagRecorder(folder) as recorder:
        for number, cloud in enumerate(clouds()):
            stamp = _BEGIN + number * _PERIOD
            header = Header(stamp=conversions.stamp_of(stamp), frame_id="phoxi_camera_sensor")
            recorder.write(TOPIC, conversions.cloud_to_msg(cloud, header), round(stamp * 1e9))


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    try:
        record(parser.parse_args(arguments).folder)
    except SingulationError as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
