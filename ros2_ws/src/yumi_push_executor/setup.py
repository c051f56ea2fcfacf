from setuptools import find_packages, setup

PACKAGE = "yumi_push_executor"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed", "urdf/*.urdf"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/urdf", [f"{PACKAGE}/urdf/yumi.urdf"]),
    ],
    install_requires=["setuptools"],
    zip_safe=False,
    maintainer="Singulation maintainers",
    maintainer_email="maintainers@users.noreply.github.com",
    description="From a push to a supervised closed-jaw, jaw-side or open-jaw motion of an ABB YuMi.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "executor_node = yumi_push_executor.executor_node:main",
        ]
    },
)
