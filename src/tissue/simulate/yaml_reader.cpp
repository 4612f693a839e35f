#include "yaml_reader.h"

#include <cmath>
#include <cstdlib>
#include <utility>

namespace tissue {

void YamlReader::refuse(ErrorCode code, const std::string& what) const {
  const YAML::Mark mark = node_.Mark();
  const std::string line = mark.line >= 0 ? "line " + std::to_string(mark.line + 1) + ", " : "";
  throw InputError(code, "scene: " + line + key_ + ": " + what);
}

void YamlReader::require_keys(std::initializer_list<const char*> known) const {
  if (!node_.IsMap()) refuse(ErrorCode::kScene, "is not a map of keys and values");
  std::string list;
  for (const char* key : known) list += std::string(list.empty() ? "" : " ") + key;
  for (const YamlReader& member : members()) {
    bool found = false;
    for (const char* key : known) found = found || member.key_ == key;
    if (!found) {
      member.refuse(ErrorCode::kScene, "is not a key of " + key_ + ", which knows " + list);
    }
  }
}

YamlReader YamlReader::at(const char* key) const {
  const YAML::Node node = node_[key];
  if (!node.IsDefined()) refuse(ErrorCode::kScene, std::string("has no key ") + key);
  return {node, key};
}

std::vector<YamlReader> YamlReader::entries() const {
  if (!node_.IsSequence()) refuse(ErrorCode::kScene, "is not a list");
  std::vector<YamlReader> result;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    result.emplace_back(node_[i], key_ + "[" + std::to_string(i) + "]");
  }
  return result;
}

std::vector<YamlReader> YamlReader::members() const {
  if (!node_.IsMap()) refuse(ErrorCode::kScene, "is not a map of keys and values");
  std::vector<YamlReader> result;
  for (const auto& member : node_) {
    if (!member.first.IsScalar()) refuse(ErrorCode::kScene, "has a key that is not a word");
    result.emplace_back(member.second, member.first.Scalar());
  }
  return result;
}

std::string YamlReader::word() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) refuse(ErrorCode::kScene, "is not a word");
  return node_.Scalar();
}

double YamlReader::number(double lowest, double highest, bool open) const {
  const std::string text = node_.IsScalar() ? node_.Scalar() : std::string();
  double value = 0.0;
  try {
    value = node_.as<double>();
  } catch (const YAML::Exception&) {
    refuse(ErrorCode::kParam, "'" + text + "' is not a number");
  }
  const bool inside =
      open ? value > lowest && value < highest : value >= lowest && value <= highest;
  if (!std::isfinite(value) || !inside) {
    refuse(ErrorCode::kParam, text + " is not " + (open ? "between " : "within ") +
                                  to_text(lowest) + (open ? " and " : " to ") + to_text(highest));
  }
  return value;
}

bool YamlReader::flag() const {
  try {
    return node_.as<bool>();
  } catch (const YAML::Exception&) {
    refuse(ErrorCode::kParam, "is not true or false");
  }
}

}  // namespace tissue
