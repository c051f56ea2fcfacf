#include "pipeline.hpp"

#include <stdexcept>

#include <pcl/common/eigen.h>  // before polygon_operations.h, which lacks it
#include <pcl/filters/crop_box.h>
#include <pcl/filters/extract_indices.h>
#include <pcl/filters/passthrough.h>
#include <pcl/filters/project_inliers.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/geometry/polygon_operations.h>
#include <pcl/search/kdtree.h>
#include <pcl/segmentation/extract_clusters.h>
#include <pcl/segmentation/sac_segmentation.h>
#include <pcl/surface/convex_hull.h>

namespace {

constexpr double kBelow = -0.02, kAbove = 0.10;  // slice of space around the table that is looked at
constexpr double kPlaneDistance = 0.003;
constexpr int kPlaneIterations = 100;
constexpr float kPolygonTolerance = 0.003F;

Cloud::Ptr between(const Cloud::Ptr& cloud, const std::string& axis, float low, float high) {
  pcl::PassThrough<pcl::PointXYZ> filter;
  filter.setInputCloud(cloud);
  filter.setFilterFieldName(axis);
  filter.setFilterLimits(low, high);
  auto kept = pcl::make_shared<Cloud>();
  filter.filter(*kept);
  return kept;
}

// Along the axes of the camera, around the slice of the workspace: a little more than CropBox keeps.
Cloud::Ptr passed_through(const Cloud::Ptr& cloud, const Recipe& recipe) {
  const auto& [x_min, x_max, y_min, y_max] = recipe.workspace;
  const Eigen::Affine3f camera_from_table = recipe.table_from_camera.inverse();
  Eigen::AlignedBox3f box;
  for (const double x : {x_min, x_max}) {
    for (const double y : {y_min, y_max}) {
      for (const double z : {kBelow, kAbove}) box.extend(camera_from_table * Eigen::Vector3d(x, y, z).cast<float>());
    }
  }
  const auto in_x = between(cloud, "x", box.min().x(), box.max().x());
  const auto in_y = between(in_x, "y", box.min().y(), box.max().y());
  return between(in_y, "z", box.min().z(), box.max().z());
}

// One pass over the cloud where three PassThrough filters need three; drops invalid points too.
Cloud::Ptr boxed(const Cloud::Ptr& cloud, const Recipe& recipe) {
  const auto& [x_min, x_max, y_min, y_max] = recipe.workspace;
  pcl::CropBox<pcl::PointXYZ> box;
  box.setInputCloud(cloud);
  box.setTransform(recipe.table_from_camera);
  box.setMin(Eigen::Vector4d(x_min, y_min, kBelow, 1.0).cast<float>());
  box.setMax(Eigen::Vector4d(x_max, y_max, kAbove, 1.0).cast<float>());
  auto kept = pcl::make_shared<Cloud>();
  box.filter(*kept);
  return kept;
}

Cloud::Ptr thinned(const Cloud::Ptr& cloud, double leaf) {
  if (leaf <= 0.0) return cloud;
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(static_cast<float>(leaf), static_cast<float>(leaf), static_cast<float>(leaf));
  auto kept = pcl::make_shared<Cloud>();
  grid.filter(*kept);
  return kept;
}

pcl::ModelCoefficients::Ptr table_plane(const Cloud::Ptr& cloud, pcl::PointIndices::Ptr& inliers) {
  pcl::SACSegmentation<pcl::PointXYZ> search;
  search.setOptimizeCoefficients(true);
  search.setModelType(pcl::SACMODEL_PLANE);
  search.setMethodType(pcl::SAC_RANSAC);
  search.setMaxIterations(kPlaneIterations);
  search.setDistanceThreshold(kPlaneDistance);
  search.setInputCloud(cloud);
  auto plane = pcl::make_shared<pcl::ModelCoefficients>();
  search.segment(*inliers, *plane);
  if (inliers->indices.empty()) throw std::runtime_error("no plane");
  return plane;
}

Cloud::Ptr without(const Cloud::Ptr& cloud, const pcl::PointIndices::Ptr& indices) {
  pcl::ExtractIndices<pcl::PointXYZ> extract;
  extract.setInputCloud(cloud);
  extract.setIndices(indices);
  extract.setNegative(true);
  auto kept = pcl::make_shared<Cloud>();
  extract.filter(*kept);
  return kept;
}

std::vector<pcl::PointIndices> clusters(const Cloud::Ptr& cloud, double tolerance, int low, int high, bool sorted) {
  auto tree = pcl::make_shared<pcl::search::KdTree<pcl::PointXYZ>>(sorted);
  tree->setInputCloud(cloud);
  pcl::EuclideanClusterExtraction<pcl::PointXYZ> extraction;
  extraction.setClusterTolerance(tolerance);
  extraction.setMinClusterSize(low);
  extraction.setMaxClusterSize(high);
  extraction.setSearchMethod(tree);
  extraction.setInputCloud(cloud);
  std::vector<pcl::PointIndices> found;
  extraction.extract(found);
  return found;
}

Cloud polygon(const Cloud::Ptr& cloud, const pcl::PointIndices& cluster, const pcl::ModelCoefficients::Ptr& plane) {
  pcl::ProjectInliers<pcl::PointXYZ> project;
  project.setModelType(pcl::SACMODEL_PLANE);
  project.setModelCoefficients(plane);
  project.setInputCloud(cloud);
  project.setIndices(pcl::make_shared<pcl::PointIndices>(cluster));
  auto flat = pcl::make_shared<Cloud>();
  project.filter(*flat);
  pcl::ConvexHull<pcl::PointXYZ> hull;
  hull.setInputCloud(flat);
  hull.setDimension(2);
  Cloud ring;
  hull.reconstruct(ring);
  Cloud::VectorType corners;
  pcl::approximatePolygon2D<pcl::PointXYZ>(ring.points, corners, kPolygonTolerance, false, true);
  Cloud result;
  result.insert(result.end(), corners.begin(), corners.end());
  return result;
}

}  // namespace

Outlines outlines(const Cloud::Ptr& cloud, const Recipe& recipe) {
  const auto near = thinned(recipe.pass_through ? passed_through(cloud, recipe) : boxed(cloud, recipe), recipe.leaf);
  auto on_table = pcl::make_shared<pcl::PointIndices>();
  const auto plane = table_plane(near, on_table);
  const auto above = without(near, on_table);
  Outlines result;
  result.clustered = above->size();
  for (const auto& cluster : clusters(above, recipe.tolerance, recipe.min_size, 10'000'000, false)) {
    result.polygons.push_back(polygon(above, cluster, plane));
  }
  return result;
}

std::vector<int> euclidean_labels(const Cloud::Ptr& cloud, double tolerance, int min_size, int max_size, bool sorted) {
  std::vector<int> labels(cloud->size(), -1);
  int number = 0;
  for (const auto& cluster : clusters(cloud, tolerance, min_size, max_size, sorted)) {
    for (const auto index : cluster.indices) labels[index] = number;
    ++number;
  }
  return labels;
}
