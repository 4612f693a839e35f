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

/// Runs `work`; nothing that it throws gets past. An exception that leaves a callback would end the
/// node.
template <class Work>
Outcome guarded(const Work& work) {
  try {
    work();
    return {};
  } catch (const tissue::InputError& error) {
    return {error.code(), error.what()};
  } catch (const std::bad_alloc&) {
    return {tissue::ErrorCode::kNomem, "out of memory"};
  } catch (const std::exception& error) {
    return {tissue::ErrorCode::kInternal, error.what()};
  }
}

}  // namespace tissue_ros
