#pragma once

#include <ros/node_handle.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <string>
#include <vector>

namespace tissue_ros {

/// Numbers that a parameter may be, ends included.
struct Range {
  double lowest, highest;
};

/// Where the parameters of a node come from: files, which are there after a roscore restart too, and
/// the parameter server, which goes over them.
class Settings {
 public:
  /// Of a kind of node, such as `deformer_node`, whose section each file may have; later files go
  /// over earlier ones. Throws tissue::InputError E_FILE for what is no YAML.
  explicit Settings(std::string node, const std::vector<std::string>& files = {});

  /// All parameters, with their own defaults for what nobody says. Throws tissue::InputError, whose
  /// sentence names parameter and value: E_PARAM for another type, what is out of range and what in
  /// a file is no parameter, E_NONFINITE for what is not finite.
  template <class Parameters>
  Parameters read(const ros::NodeHandle& private_handle) const {
    Parameters parameters = in_files<Parameters>();
    parameters.visit([&](const char* name, auto& value, const auto&... range) {
      XmlRpc::XmlRpcValue said;
      if (private_handle.getParam(name, said)) take(name, from_server(said), value, range...);
    });
    return parameters;
  }
  /// The same of the files alone.
  template <class Parameters>
  Parameters in_files() const {
    Parameters parameters;
    std::vector<std::string> known;
    parameters.visit([&](const char* name, auto& value, const auto&... range) {
      known.push_back(name);
      const auto said = values_.find(name);
      if (said != values_.end()) take(name, said->second, value, range...);
    });
    require_known(known);
    return parameters;
  }

 private:
  static YAML::Node from_server(XmlRpc::XmlRpcValue& value);
  static void take(const char* name, const YAML::Node& said, std::string& value);
  static void take(const char* name, const YAML::Node& said, bool& value);
  static void take(const char* name, const YAML::Node& said, int& value, Range range);
  static void take(const char* name, const YAML::Node& said, double& value, Range range);
  /// A list may also be a word that reads as one, as on a command line.
  static void take(const char* name, const YAML::Node& said, std::vector<double>& value);
  void require_known(const std::vector<std::string>& known) const;

  std::string node_;
  std::map<std::string, YAML::Node> values_;
};

}  // namespace tissue_ros
