"""Public drivers of robot, gripper and camera behind the names and messages of the suite."""
