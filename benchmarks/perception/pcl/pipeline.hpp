// From a raw cloud to polygons in the way the PCL tutorials show: crop, thin out, table plane, clusters, hulls.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <pcl/ModelCoefficients.h>
#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

using Cloud = pcl::PointCloud<pcl::PointXYZ>;

// What the job needs to know; lengths in metres.
struct Recipe {
  double leaf = 0.0;              // of the voxel grid, 0 for none
  double tolerance = 0.005;       // of the clustering
  int min_size = 100;             // of a cluster, in points
  bool pass_through = false;      // crop with three PassThrough filters as the tutorials do, else with one CropBox
  std::array<double, 4> workspace{};  // x_min, x_max, y_min, y_max in the frame of the table
  Eigen::Affine3f table_from_camera = Eigen::Affine3f::Identity();
};

struct Outlines {
  std::vector<Cloud> polygons;  // in the camera frame, on the table plane
  std::size_t clustered = 0;    // points that were clustered
};

// Throws std::runtime_error if there is no plane.
Outlines outlines(const Cloud::Ptr& cloud, const Recipe& recipe);

// Label of each point, -1 for none; PCL's own default search tree is sorted, the unsorted one is faster.
std::vector<int> euclidean_labels(const Cloud::Ptr& cloud, double tolerance, int min_size, int max_size, bool sorted);
