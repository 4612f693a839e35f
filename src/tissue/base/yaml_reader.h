#pragma once

#include "tissue/base/error.h"

#include <yaml-cpp/yaml.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace tissue {

/// What a YAML file is for, and the code of an error in its structure.
struct YamlKind {
  std::string name;
  ErrorCode code = ErrorCode::kParam;
};

/// A place in a YAML file that knows its name, so that whatever is wrong can be said with line and
/// key.
class YamlReader {
 public:
  /// The whole of a file. Throws InputError of the kind's code where it is not YAML.
  YamlReader(const std::string& text, YamlKind kind);

  const std::string& key() const { return key_; }
  bool is_word() const { return node_.IsScalar(); }
  bool is_list() const { return node_.IsSequence(); }
  bool is_map() const { return node_.IsMap(); }

  [[noreturn]] void refuse(ErrorCode code, const std::string& what) const;
  /// With the kind's code.
  [[noreturn]] void refuse(const std::string& what) const { refuse(kind_.code, what); }

  /// Throws unless this is a map with no keys but these.
  void require_keys(std::initializer_list<const char*> known) const;
  bool has(const char* key) const { return node_[key].IsDefined(); }
  YamlReader at(const char* key) const;
  /// The entries of a list, named key[0], key[1], …
  std::vector<YamlReader> entries() const;
  /// The values of a map and their keys.
  std::vector<YamlReader> members() const;

  std::string word() const;
  /// All that it holds, as YAML.
  std::string text() const { return YAML::Dump(node_); }
  /// A number within [lowest, highest], ends excluded where `open`.
  double number(double lowest, double highest, bool open = false) const;
  /// A whole number within [lowest, highest].
  std::int64_t whole(std::int64_t lowest, std::int64_t highest) const;
  bool flag() const;

 private:
  YamlReader(YAML::Node node, std::string key, YamlKind kind)
      : node_(std::move(node)), key_(std::move(key)), kind_(std::move(kind)) {}

  YAML::Node node_;
  std::string key_;
  YamlKind kind_;
};

/// The text of a file. Throws InputError E_FILE that names `what` and the path.
std::string text_of_file(const std::string& path, const std::string& what);

}  // namespace tissue
