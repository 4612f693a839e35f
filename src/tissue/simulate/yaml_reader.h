#pragma once

#include "tissue/base/error.h"

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace tissue {

/// A place in a YAML file that knows its name, so that whatever is wrong can be said with line and
/// key.
class YamlReader {
 public:
  YamlReader(YAML::Node node, std::string key) : node_(std::move(node)), key_(std::move(key)) {}

  const std::string& key() const { return key_; }
  bool is_word() const { return node_.IsScalar(); }
  bool is_list() const { return node_.IsSequence(); }
  bool is_map() const { return node_.IsMap(); }

  [[noreturn]] void refuse(ErrorCode code, const std::string& what) const;

  /// Throws unless this is a map with no keys but these.
  void require_keys(std::initializer_list<const char*> known) const;
  bool has(const char* key) const { return node_[key].IsDefined(); }
  YamlReader at(const char* key) const;
  /// The entries of a list, named key[0], key[1], …
  std::vector<YamlReader> entries() const;
  /// The values of a map and their keys.
  std::vector<YamlReader> members() const;

  std::string word() const;
  /// A number within [lowest, highest], ends excluded where `open`.
  double number(double lowest, double highest, bool open = false) const;
  bool flag() const;

 private:
  YAML::Node node_;
  std::string key_;
};

}  // namespace tissue
