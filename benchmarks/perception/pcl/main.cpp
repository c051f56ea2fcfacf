// A rival that is asked line by line on its standard input, so that both sides take turns on the same machine:
//   load POINTS                    float32 x y z of every point from a file, invalid ones as NaN
//   convert                        the same points from a message into PCL's own cloud, as every PCL node begins
//   pipeline LEAF TOLERANCE MIN PASS_THROUGH X_MIN X_MAX Y_MIN Y_MAX M00 .. M23 (table_from_camera, by rows)
//   clusters TOLERANCE SORTED OUT  labels as int32 into a file
// Each answer is one line: processor milliseconds of this thread, wall milliseconds, then what was found.
#include <time.h>

#include <chrono>
#include <exception>
#include <fstream>
#include <functional>
#include <iostream>
#include <limits>
#include <sstream>

#include <pcl/PCLPointCloud2.h>
#include <pcl/conversions.h>

#include "pipeline.hpp"

namespace {

double processor_milliseconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

void timed(std::ostream& answer, const std::function<void()>& work) {
  const auto wall = std::chrono::steady_clock::now();
  const double processor = processor_milliseconds();
  work();
  answer << processor_milliseconds() - processor << ' '
         << std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count();
}

pcl::PCLPointCloud2 message_from(const std::string& path) {
  std::ifstream file(path, std::ios::binary | std::ios::ate);
  if (!file) throw std::runtime_error("cannot open " + path);
  pcl::PCLPointCloud2 message;
  message.data.resize(static_cast<std::size_t>(file.tellg()));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(message.data.data()), static_cast<std::streamsize>(message.data.size()));
  for (const auto* name : {"x", "y", "z"}) {
    pcl::PCLPointField field;
    field.name = name;
    field.offset = static_cast<std::uint32_t>(message.fields.size() * sizeof(float));
    field.datatype = pcl::PCLPointField::FLOAT32;
    field.count = 1;
    message.fields.push_back(field);
  }
  message.point_step = 3 * sizeof(float);
  message.height = 1;
  message.width = static_cast<std::uint32_t>(message.data.size() / message.point_step);
  message.row_step = message.width * message.point_step;
  message.is_dense = false;
  return message;
}

// What was asked for so far: the message that was loaded and PCL's cloud made of it.
struct Loaded {
  pcl::PCLPointCloud2 message;
  Cloud::Ptr cloud = pcl::make_shared<Cloud>();

  void convert() {
    cloud = pcl::make_shared<Cloud>();
    pcl::fromPCLPointCloud2(message, *cloud);
  }
};

Recipe recipe_from(std::istream& words) {
  Recipe recipe;
  words >> recipe.leaf >> recipe.tolerance >> recipe.min_size >> recipe.pass_through;
  for (auto& limit : recipe.workspace) words >> limit;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 4; ++column) words >> recipe.table_from_camera(row, column);
  }
  if (!words) throw std::runtime_error("pipeline: need 20 numbers");
  return recipe;
}

void pipeline(const Cloud::Ptr& cloud, std::istream& words, std::ostream& answer) {
  const Recipe recipe = recipe_from(words);
  Outlines found;
  timed(answer, [&] { found = outlines(cloud, recipe); });
  answer << ' ' << found.clustered << ' ' << found.polygons.size();
  for (const auto& polygon : found.polygons) {
    answer << ' ' << polygon.size();
    for (const auto& corner : polygon) {
      const Eigen::Vector3f placed = recipe.table_from_camera * corner.getVector3fMap();
      answer << ' ' << placed.x() << ' ' << placed.y();
    }
  }
}

void clusters(const Cloud::Ptr& cloud, std::istream& words, std::ostream& answer) {
  double tolerance = 0.0;
  bool sorted = false;
  std::string path;
  words >> tolerance >> sorted >> path;
  std::vector<int> labels;
  timed(answer, [&] { labels = euclidean_labels(cloud, tolerance, 1, std::numeric_limits<int>::max(), sorted); });
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<const char*>(labels.data()), static_cast<std::streamsize>(labels.size() * sizeof(int)));
}

void answer_line(const std::string& line, Loaded& loaded, std::ostream& answer) {
  std::istringstream words(line);
  std::string command;
  words >> command;
  if (command == "load") {
    std::string path;
    words >> path;
    loaded.message = message_from(path);
    loaded.convert();
    answer << loaded.cloud->size();
  } else if (command == "convert") {
    timed(answer, [&] { loaded.convert(); });
  } else if (command == "pipeline") {
    pipeline(loaded.cloud, words, answer);
  } else if (command == "clusters") {
    clusters(loaded.cloud, words, answer);
  } else {
    throw std::runtime_error("unknown command " + command);
  }
}

}  // namespace

int main() {
  Loaded loaded;
  for (std::string line; std::getline(std::cin, line);) {
    std::ostringstream answer;
    answer.precision(9);
    try {
      answer_line(line, loaded, answer);
      std::cout << "ok " << answer.str() << std::endl;
    } catch (const std::exception& error) {
      std::cout << "error " << error.what() << std::endl;
    }
  }
  return 0;
}
