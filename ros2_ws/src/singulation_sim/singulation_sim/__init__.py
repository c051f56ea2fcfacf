"""Stand-ins for the hardware: simulated YuMi driver, table physics, PhoXi camera."""
