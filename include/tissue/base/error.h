#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>

namespace tissue {

/// What kind of input was refused. The values are those of the constants in msg/Result.msg.
enum class ErrorCode : std::uint8_t {
  kOk = 0,
  kSizeMismatch = 1,
  kDims = 2,
  kTooLarge = 3,
  kSpacing = 4,
  kEncoding = 5,
  kNonfinite = 6,
  kEmptySurface = 7,
  kTooSmall = 8,
  kDirection = 9,
  kNonuniform = 10,
  kComplexity = 11,
  kFrame = 12,
  kN = 13,
  kTooManyTets = 14,
  kNTinit = 15,
  kParam = 16,
  kBusy = 17,
  kPath = 18,
  kFile = 19,
  kMeshQuality = 20,
  kDt = 21,
  kUnconstrained = 22,
  kConformity = 23,
  kIo = 24,
  kNomem = 25,
  kNoVolume = 26,
  kCancelled = 27,
  kScene = 28,
  kInternal = 29,
};

/// The constant's name in msg/Result.msg, such as "E_SPACING".
const char* name(ErrorCode code);

/// Input that the caller got wrong. `what()` is one sentence that names the field and the value;
/// nothing has been changed when it is thrown.
class InputError : public std::invalid_argument {
 public:
  InputError(ErrorCode code, const std::string& sentence)
      : std::invalid_argument(sentence), code_(code) {}
  ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

/// A number as short as it can be said: "0.25", "1e-09", "nan".
std::string to_text(double value);

}  // namespace tissue
