#include "tissue/base/safe_path.h"

#include "tissue/base/error.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace tissue {
namespace {

constexpr std::size_t kLongestName = 1024;
// In the names of temporaries, before their writer's process id.
constexpr char kPart[] = ".part";

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

AtomicFile::AtomicFile(std::string path) : path_(std::move(path)), temporary_(path_) {
  // Before the ending, because some writers append the one they expect.
  const std::size_t slash = path_.rfind('/'), dot = path_.rfind('.');
  const bool has_ending = dot != std::string::npos && (slash == std::string::npos || dot > slash);
  temporary_.insert(has_ending ? dot : path_.size(), kPart + std::to_string(getpid()));
}

AtomicFile::~AtomicFile() {
  if (!temporary_.empty()) std::remove(temporary_.c_str());
}

void AtomicFile::commit() {
  const auto refuse_io = [&](const char* what) {
    throw InputError(ErrorCode::kIo, "output: '" + path_ + "' cannot be " + what);
  };
  const int file = open(temporary_.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC);
  if (file < 0) refuse_io("written");
  const bool flushed = fsync(file) == 0;
  if (close(file) != 0 || !flushed) refuse_io("flushed to the disk");
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) refuse_io("renamed");
  temporary_.clear();
}

void remove_unfinished(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code failed;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
    const std::string name = entry.path().filename().string();
    const std::size_t mark = name.rfind(kPart);
    if (mark == std::string::npos) continue;
    const pid_t writer = std::atoi(name.c_str() + mark + std::strlen(kPart));
    const bool is_gone = writer > 0 && kill(writer, 0) != 0 && errno == ESRCH;
    if (is_gone) fs::remove(entry.path(), failed);
  }
}

}  // namespace tissue
