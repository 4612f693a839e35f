#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>

namespace tissue_fuzz {

/// Takes any bytes as what somebody sent. Refusing them by tissue::InputError is well; whatever
/// else is thrown, and what is taken although it is not sound, is not.
using Target = void (*)(const std::uint8_t* data, std::size_t size);

/// The package's own decoders by name; test/fuzz/corpus has a folder for each.
const std::map<std::string, Target>& targets();

}  // namespace tissue_fuzz
