#include "yaml_reader.h"

#include <cmath>
#include <fstream>
#include <sstream>
#include <utility>

namespace tissue {

YamlReader::YamlReader(const std::string& text, YamlKind kind)
    : key_(kind.name), kind_(std::move(kind)) {
  try {
    node_ = YAML::Load(text);
  } catch (const YAML::Exception& exception) {
    throw InputError(kind_.code, kind_.name + ": not YAML: " + exception.what());
  }
}

void YamlReader::refuse(ErrorCode code, const std::string& what) const {
  const YAML::Mark mark = node_.Mark();
  const std::string line = mark.line >= 0 ? "line " + std::to_string(mark.line + 1) + ", " : "";
  throw InputError(code, kind_.name + ": " + line + key_ + ": " + what);
}

void YamlReader::require_keys(std::initializer_list<const char*> known) const {
  if (!node_.IsMap()) refuse("is not a map of keys and values");
  std::string list;
  for (const char* key : known) list += std::string(list.empty() ? "" : " ") + key;
  for (const YamlReader& member : members()) {
    bool found = false;
    for (const char* key : known) found = found || member.key_ == key;
    if (!found) {
      member.refuse("is not a key of " + key_ + ", which knows " + list);
    }
  }
}

YamlReader YamlReader::at(const char* key) const {
  const YAML::Node node = node_[key];
  if (!node.IsDefined()) refuse(std::string("has no key ") + key);
  return {node, key, kind_};
}

std::vector<YamlReader> YamlReader::entries() const {
  if (!node_.IsSequence()) refuse("is not a list");
  std::vector<YamlReader> result;
  for (std::size_t i = 0; i < node_.size(); ++i) {
    result.push_back({node_[i], key_ + "[" + std::to_string(i) + "]", kind_});
  }
  return result;
}

std::vector<YamlReader> YamlReader::members() const {
  if (!node_.IsMap()) refuse("is not a map of keys and values");
  std::vector<YamlReader> result;
  for (const auto& member : node_) {
    if (!member.first.IsScalar()) refuse("has a key that is not a word");
    result.push_back({member.second, member.first.Scalar(), kind_});
  }
  return result;
}

std::string YamlReader::word() const {
  if (!node_.IsScalar() || node_.Scalar().empty()) refuse("is not a word");
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

std::int64_t YamlReader::whole(std::int64_t lowest, std::int64_t highest) const {
  const double value = number(static_cast<double>(lowest), static_cast<double>(highest));
  if (std::floor(value) != value) refuse(ErrorCode::kParam, word() + " is not a whole number");
  return static_cast<std::int64_t>(value);
}

bool YamlReader::flag() const {
  try {
    return node_.as<bool>();
  } catch (const YAML::Exception&) {
    refuse(ErrorCode::kParam, "is not true or false");
  }
}

std::string text_of_file(const std::string& path, const std::string& what) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  if (!file) throw InputError(ErrorCode::kFile, what + ": '" + path + "' cannot be read");
  return text.str();
}

}  // namespace tissue
