"""The main job in one command: recorded clouds, then the closed loop in the simulated cell."""
