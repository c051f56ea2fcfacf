from pathlib import Path

from setuptools import find_packages, setup

PACKAGE = "singulation_bringup"


def shared(*folders):
    """Files below these folders, for share/<package>."""
    found = {}
    for folder in folders:
        for path in sorted(Path(folder).rglob("*")):
            if path.is_file():
                found.setdefault(f"share/{PACKAGE}/{path.parent}", []).append(str(path))
    return list(found.items())


setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        *shared("launch", "config", "rviz", "foxglove", "security"),
    ],
    install_requires=["setuptools"],
    zip_safe=False,
    maintainer="Singulation maintainers",
    maintainer_email="maintainers@users.noreply.github.com",
    description="Brings the suite up: coordinator, launch files, parameter files, displays.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "closed_loop_benchmark = singulation_bringup.closed_loop.main:main",
            "singulate_node = singulation_bringup.singulate_node:main",
            "compile_kernels = singulation_bringup.commands.compile_kernels:main",
            "status = singulation_bringup.commands.status:main",
            "operate = singulation_bringup.commands.operate:main",
            "calibrate = singulation_bringup.commands.calibrate:main",
            "bring_up = singulation_bringup.commands.bring_up:main",
            "dry_run = singulation_bringup.dry_run.dry_run:main",
            "driver_state_adapter = singulation_bringup.adapters.driver_state_adapter:main",
            "smart_gripper_adapter = singulation_bringup.adapters.smart_gripper_adapter:main",
            "camera_trigger = singulation_bringup.adapters.camera_trigger:main",
            "cell_frames = singulation_bringup.adapters.cell_frames:main",
        ]
    },
)
