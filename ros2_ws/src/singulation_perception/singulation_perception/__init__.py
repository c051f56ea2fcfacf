"""From a PhoXi point cloud to convex polygons on the table."""

from singulation_perception.parameters import SegmentationParameters
from singulation_perception.segmentation import Segmentation, segment, segment_cloud, warm_up
from singulation_perception.table_plane import TablePlane

__all__ = ["Segmentation", "SegmentationParameters", "TablePlane", "segment", "segment_cloud", "warm_up"]
