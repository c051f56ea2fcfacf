"""From a PhoXi point cloud to convex polygons on the table."""

from pathlib import Path

import singulation_core
from singulation_perception.compiled_caches import drop_stale_caches
from singulation_perception.parameters import SegmentationParameters
from singulation_perception.segmentation import Segmentation, segment, segment_cloud
from singulation_perception.surfaces import connected_runs
from singulation_perception.table_plane import TablePlane
from singulation_perception.warming import warm_up

__all__ = ["Segmentation", "SegmentationParameters", "TablePlane", "segment", "segment_cloud", "warm_up"]

_SOURCES = [Path(__file__).parent, Path(singulation_core.__file__).parent]
drop_stale_caches(_SOURCES, Path(connected_runs.stats.cache_path))
