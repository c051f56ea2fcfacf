"""Where table and camera stand, from clouds and from points touched with the robot."""
