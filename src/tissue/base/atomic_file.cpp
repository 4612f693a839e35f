#include "tissue/base/atomic_file.h"

#include "tissue/base/error.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <utility>

namespace tissue {
namespace {

// In the names of temporaries, before their writer's process id.
constexpr char kPart[] = ".part";

}  // namespace

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
