from setuptools import find_packages, setup

PACKAGE = "singulation_perception"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=False,
    maintainer="Singulation maintainers",
    maintainer_email="maintainers@users.noreply.github.com",
    description="From a PhoXi point cloud to convex polygons on the table.",
    license="Apache-2.0",
    entry_points={
        "console_scripts": [
            "perception_node = singulation_perception.perception_node:main",
            "record_clouds = singulation_perception.record_clouds:main",
            "replay_clouds = singulation_perception.replay_clouds:main",
        ]
    },
)
