"""From a PhoXi point cloud to convex polygons on the table."""
