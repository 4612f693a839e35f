#pragma once

#include <string>

namespace tissue {

/// A file that appears under its name when it is complete: written under a temporary name beside
/// it, flushed to the disk and renamed. Whatever goes wrong leaves an old file as it was.
class AtomicFile {
 public:
  explicit AtomicFile(std::string path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  /// Where to write.
  const std::string& temporary() const { return temporary_; }
  /// Throws InputError E_IO if the file cannot be flushed or renamed.
  void commit();

 private:
  std::string path_, temporary_;
};

/// Removes what writers in this folder left unfinished when they were killed: temporaries of
/// processes that are no more.
void remove_unfinished(const std::string& folder);

}  // namespace tissue
