"""How long a cloud takes from the camera's process to the arrangement in another one."""
