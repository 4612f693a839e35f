#include "ros/settings.h"

#include "tissue/base/error.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tissue_ros {
namespace {

using tissue::ErrorCode;
using tissue::InputError;

[[noreturn]] void refuse(ErrorCode code, const char* name, const YAML::Node& said,
                         const std::string& why) {
  throw InputError(code, std::string("~") + name + ": " + YAML::Dump(said) + " " + why);
}

template <class Value>
Value as(const char* name, const YAML::Node& said, const char* wanted) {
  try {
    return said.as<Value>();
  } catch (const YAML::Exception&) {
    refuse(ErrorCode::kParam, name, said, std::string("is not ") + wanted);
  }
}

double number(const char* name, const YAML::Node& said) {
  const auto value = as<double>(name, said, "a number");
  if (!std::isfinite(value)) refuse(ErrorCode::kNonfinite, name, said, "is not finite");
  return value;
}

void require_within(const char* name, const YAML::Node& said, double value, Range range) {
  if (value >= range.lowest && value <= range.highest) return;
  refuse(
      ErrorCode::kParam, name, said,
      "is not between " + tissue::to_text(range.lowest) + " and " + tissue::to_text(range.highest));
}

}  // namespace

Settings::Settings(std::string node, const std::vector<std::string>& files)
    : node_(std::move(node)) {
  for (const std::string& file : files) {
    try {
      const YAML::Node section = YAML::LoadFile(file)[node_];
      for (const auto& entry : section) values_[entry.first.as<std::string>()] = entry.second;
    } catch (const YAML::Exception& error) {
      throw InputError(ErrorCode::kFile, "settings: '" + file + "': " + error.what());
    }
  }
}

YAML::Node Settings::from_server(XmlRpc::XmlRpcValue& value) {
  using Value = XmlRpc::XmlRpcValue;
  switch (value.getType()) {
    case Value::TypeBoolean: return YAML::Node(static_cast<bool>(value));
    case Value::TypeInt: return YAML::Node(static_cast<int>(value));
    case Value::TypeDouble: return YAML::Node(static_cast<double>(value));
    case Value::TypeString: return YAML::Node(static_cast<std::string>(value));
    case Value::TypeArray: break;
    default: return YAML::Node();
  }
  YAML::Node list(YAML::NodeType::Sequence);
  for (int i = 0; i < value.size(); ++i) list.push_back(from_server(value[i]));
  return list;
}

void Settings::take(const char* name, const YAML::Node& said, std::string& value) {
  value = as<std::string>(name, said, "a word");
}

void Settings::take(const char* name, const YAML::Node& said, bool& value) {
  value = as<bool>(name, said, "true or false");
}

void Settings::take(const char* name, const YAML::Node& said, int& value, Range range) {
  const auto whole = as<long long>(name, said, "a whole number");
  require_within(name, said, static_cast<double>(whole), range);
  value = static_cast<int>(whole);
}

void Settings::take(const char* name, const YAML::Node& said, double& value, Range range) {
  const double found = number(name, said);
  require_within(name, said, found, range);
  value = found;
}

void Settings::take(const char* name, const YAML::Node& said, std::vector<double>& value) {
  YAML::Node list = said;
  if (said.IsScalar()) {
    try {
      list = YAML::Load(said.as<std::string>());
    } catch (const YAML::Exception&) {
      refuse(ErrorCode::kParam, name, said, "is not a list of numbers");
    }
  }
  if (!list.IsSequence()) refuse(ErrorCode::kParam, name, said, "is not a list of numbers");
  value.clear();
  for (const YAML::Node& entry : list) value.push_back(number(name, entry));
}

void Settings::require_known(const std::vector<std::string>& known) const {
  for (const auto& [name, said] : values_) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw InputError(ErrorCode::kParam, "settings: '" + name + "' is not a parameter of " + node_);
  }
}

}  // namespace tissue_ros
