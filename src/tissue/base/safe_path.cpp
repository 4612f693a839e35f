#include "tissue/base/safe_path.h"

#include "tissue/base/error.h"

#include <sys/stat.h>

#include <climits>
#include <cstdlib>

namespace tissue {
namespace {

constexpr std::size_t kLongestName = 1024;

// For messages: short, and without what a terminal would act on.
std::string shown(const std::string& name) {
  std::string text = name.substr(0, 60);
  for (char& c : text) {
    if (static_cast<unsigned char>(c) < 32 || c == 127) c = '?';
  }
  return "'" + text + (name.size() > 60 ? "…'" : "'");
}

[[noreturn]] void refuse(const std::string& name, const std::string& why) {
  throw InputError(ErrorCode::kPath, "path: " + shown(name) + " " + why);
}

std::string real_path(const std::string& path) {
  char resolved[PATH_MAX];
  return realpath(path.c_str(), resolved) != nullptr ? resolved : std::string();
}

}  // namespace

std::string confined_path(const std::string& folder, const std::string& name, bool must_exist) {
  if (name.empty()) refuse(name, "is empty");
  if (name.size() > kLongestName) {
    refuse(name, "has " + std::to_string(name.size()) + " characters, more than " +
                     std::to_string(kLongestName));
  }
  for (const char c : name) {
    if (static_cast<unsigned char>(c) < 32) refuse(name, "holds a control character");
  }
  if (name[0] == '/') refuse(name, "is absolute; it has to lie below the folder of meshes");
  if (("/" + name + "/").find("/../") != std::string::npos) refuse(name, "leads upwards");
  const std::string root = real_path(folder);
  if (root.empty()) refuse(folder, "is no folder");
  const std::size_t slash = name.rfind('/');
  const std::string parent =
      real_path(slash == std::string::npos ? root : root + "/" + name.substr(0, slash));
  if (parent.empty()) refuse(name, "lies in a folder that does not exist");
  if (parent != root && parent.compare(0, root.size() + 1, root + "/") != 0) {
    refuse(name, "is led out of the folder by a link");
  }
  const std::string file = slash == std::string::npos ? name : name.substr(slash + 1);
  if (file.empty() || file == "." || file == "..") refuse(name, "names no file");
  const std::string path = parent + "/" + file;
  struct stat status {};
  if (lstat(path.c_str(), &status) != 0) {
    if (must_exist) refuse(name, "does not exist");
  } else if (!S_ISREG(status.st_mode)) {
    refuse(name, "is no regular file");
  }
  return path;
}

}  // namespace tissue
