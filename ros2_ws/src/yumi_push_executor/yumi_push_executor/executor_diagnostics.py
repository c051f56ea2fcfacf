"""What the executor says of itself once a second."""

from singulation_core import ResultCode
from singulation_node.diagnostics import Diagnostics
from yumi_push_executor.controllers import Controllers
from yumi_push_executor.goal_ledger import GoalLedger
from yumi_push_executor.robot_view import RobotView
from yumi_push_executor.supervision import DriverMode, Instant


def report_executor(
    diagnostics: Diagnostics, view: RobotView, now: Instant, ledger: GoalLedger, controllers: Controllers
) -> None:
    """Joint states, driver, goals and controllers."""
    _report_robot(diagnostics, view, now)
    counts = ledger.counts()
    defects = ledger.ended(ResultCode.INTERNAL)
    diagnostics.report("goals", defects == 0, f"{counts['received']} received", **counts)
    problems = controllers.problems()
    diagnostics.report("controllers", not problems, "; ".join(problems) or "connected")


def _report_robot(diagnostics: Diagnostics, view: RobotView, now: Instant) -> None:
    with view.lock:
        fault, refused, messages, driver = view.watch.fault(now), view.watch.refused, view.messages, view.driver
    text = "good" if fault is None else fault.text
    diagnostics.report("joint states", fault is None, text, messages=messages, refused=refused)
    if driver is None:
        diagnostics.report("driver", False, "no driver state has come yet")
        return
    moves = driver.mode is DriverMode.MOTORS_ON and driver.motion_enabled
    said = f"{driver.mode.name}: {driver.message}" if driver.message else driver.mode.name
    diagnostics.report("driver", moves, said, motion_enabled=driver.motion_enabled, **driver.calibrated)
