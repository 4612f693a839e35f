#pragma once

#include "tissue/base/error.h"

#include <exception>
#include <new>
#include <string>

namespace tissue_ros {

/// What became of a piece of work.
struct Outcome {
  tissue::ErrorCode code = tissue::ErrorCode::kOk;
  std::string sentence;
  bool ok() const { return code == tissue::ErrorCode::kOk; }
};

/// What somebody else wrote, for one line of a log: control characters as \xNN, and no longer than so
/// many characters.
inline std::string printable(const std::string& text, std::size_t longest = 600) {
  constexpr const char* kHex = "0123456789abcdef";
  std::string result;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte >= 0x20 && byte != 0x7f) {
      result += c;
    } else {
      result += {'\\', 'x', kHex[byte / 16], kHex[byte % 16]};
    }
    if (result.size() >= longest) return result.substr(0, longest - 3) + "...";
  }
  return result;
}

/// Runs `work`; nothing that it throws gets past. An exception that leaves a callback would end the
/// node.
template <class Work>
Outcome guarded(const Work& work) {
  try {
    work();
    return {};
  } catch (const tissue::InputError& error) {
    return {error.code(), printable(error.what())};
  } catch (const std::bad_alloc&) {
    return {tissue::ErrorCode::kNomem, "out of memory"};
  } catch (const std::exception& error) {
    return {tissue::ErrorCode::kInternal, printable(error.what())};
  }
}

}  // namespace tissue_ros
