from singulation_node.testing import ros_context

__all__ = ["ros_context"]
