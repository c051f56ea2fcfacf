"""Parameters of ``camera_trigger``."""

from dataclasses import dataclass

from singulation_node.parameters import parameter


@dataclass(frozen=True)
class CameraTriggerSettings:
    """How Photoneo's driver is asked for a frame."""

    driver_service: str = parameter(
        "/phoxi_camera/trigger_frame", "service of the driver (phoxi_camera_msgs/TriggerFrame)", read_only=True
    )
    wait_grabbing_end: bool = parameter(
        True, "answer when the exposure is over, not when it begins; the arm stands still until then"
    )
    timeout: float = parameter(8.0, "longest wait for the driver's answer [s]", low=0.1, high=60.0)
