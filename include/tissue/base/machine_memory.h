#pragma once

#include <cstddef>

namespace tissue {

/// Bytes that this process can still take without swapping: what the system says is available, and
/// no more than its own limit on address space leaves. The largest number where neither is known.
std::size_t available_memory();

/// Bytes of this process that are in memory now; 0 where that is not known.
std::size_t resident_memory();

/// Bytes that this process has asked the allocator for and not given back; 0 where that is not
/// known. Free of what the allocator keeps for later.
std::size_t allocated_memory();

}  // namespace tissue
