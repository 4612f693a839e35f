#include "ros/node_main.h"

#include "ros/guarded.h"
#include "ros/master_watch.h"
#include "ros/parameters_text.h"

#include <ros/callback_queue.h>
#include <ros/ros.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <sstream>

namespace tissue_ros {
namespace {

volatile std::sig_atomic_t is_asked_to_end = 0;

// roslaunch starts nodes and a master at once.
constexpr double kMasterPatience = 10.0;

bool asks_for_help(int argc, char** argv) {
  return std::any_of(argv + 1, argv + argc, [](const char* argument) {
    return std::strcmp(argument, "--help") == 0 || std::strcmp(argument, "-h") == 0;
  });
}

void show(const NodeHelp& help) {
  std::printf(
      "%s [SETTINGS.yaml ...] [_PARAMETER:=VALUE ...] [TOPIC:=TOPIC ...]\n%s\n\nexample: %s\n\n"
      "Parameters with their defaults, as in config/parameters.yaml:\n",
      help.name, help.about, help.example);
  std::istringstream lines(kParametersText);
  bool is_ours = false;
  for (std::string line; std::getline(lines, line);) {
    const bool is_parameter = line.compare(0, 2, "  ") == 0;
    if (!is_parameter) is_ours = line == std::string(help.name) + ":";
    if (is_parameter && is_ours) std::puts(line.c_str());
  }
}

}  // namespace

int run_process(int argc, char** argv, const NodeHelp& help,
                const std::function<EndNode(const std::vector<std::string>& files)>& make) {
  if (asks_for_help(argc, argv)) {
    show(help);
    return 0;
  }
  const char* const name = help.name;
  const auto end = [](int) { is_asked_to_end = 1; };
  std::signal(SIGINT, end);
  std::signal(SIGTERM, end);
  ros::init(argc, argv, name, ros::init_options::NoSigintHandler);
  const ros::WallTime last = ros::WallTime::now() + ros::WallDuration(kMasterPatience);
  while (!ros::master::check()) {
    if (is_asked_to_end != 0) return 0;
    if (ros::WallTime::now() > last) {
      ROS_FATAL("%s: no master answers at %s", name, ros::master::getURI().c_str());
      return 1;
    }
    ros::WallDuration(0.1).sleep();
  }
  ros::start();
  EndNode end_node;
  const Outcome outcome =
      guarded([&] { end_node = make(std::vector<std::string>(argv + 1, argv + argc)); });
  if (!outcome.ok()) {
    ROS_FATAL("%s: %s: %s", name, tissue::name(outcome.code), outcome.sentence.c_str());
    ros::shutdown();
    return 1;
  }
  std::atomic<bool> master_is_lost{false};
  {
    const MasterWatch watch([&] { master_is_lost = true; });
    while (ros::ok() && is_asked_to_end == 0 && !master_is_lost) {
      ros::getGlobalCallbackQueue()->callAvailable(ros::WallDuration(0.05));
    }
  }
  // ROS's own log is closed by then.
  if (!ros::ok()) std::fprintf(stderr, "%s: somebody else has shut it down\n", name);
  end_node(!master_is_lost);
  // What was said last is on its way.
  ros::WallDuration(0.1).sleep();
  ros::shutdown();
  return is_asked_to_end != 0 ? 0 : 1;
}

}  // namespace tissue_ros
