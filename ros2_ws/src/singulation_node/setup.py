from setuptools import find_packages, setup

PACKAGE = "singulation_node"

setup(
    name=PACKAGE,
    version="0.1.0",
    packages=find_packages(include=[PACKAGE, f"{PACKAGE}.*"]),
    package_data={PACKAGE: ["py.typed", "*.xml"]},
    data_files=[
        ("share/ament_index/resource_index/packages", [f"resource/{PACKAGE}"]),
        (f"share/{PACKAGE}", ["package.xml"]),
        (f"share/{PACKAGE}/config", [f"{PACKAGE}/fastdds_large_clouds.xml"]),
    ],
    install_requires=["setuptools"],
    zip_safe=False,
    maintainer="Singulation maintainers",
    maintainer_email="maintainers@users.noreply.github.com",
    description="Node mechanics that every node of the suite shares.",
    license="Apache-2.0",
    entry_points={"console_scripts": []},
)
