#pragma once

namespace tissue_test {

/// Whether a sanitizer watches, which wants most of the address space for itself: limits on it then
/// test nothing but the sanitizer.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
inline constexpr bool kSanitized = true;
#else
inline constexpr bool kSanitized = false;
#endif

}  // namespace tissue_test
