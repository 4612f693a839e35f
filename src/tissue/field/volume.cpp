#include "tissue/field/volume.h"

#include "tissue/base/error.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace tissue {
namespace {

constexpr std::size_t kMaxVoxels = std::size_t{1} << 32;
constexpr double kMinSpacing = 1e-6;
constexpr double kMaxSpacing = 1.0;
constexpr double kMaxDistance = 10.0;
constexpr std::size_t kMaxNameLength = 256;
constexpr const char* kEncodings = "8UC1 16UC1 16SC1 32SC1 32FC1 64FC1";
constexpr const char* kAxisNames = "xyz";

template <class T>
T reversed_bytes(T value) {
  std::uint8_t bytes[sizeof(T)];
  std::memcpy(bytes, &value, sizeof(T));
  std::reverse(bytes, bytes + sizeof(T));
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

std::size_t checked_voxel_count(const std::array<std::uint32_t, 3>& size) {
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] == 0) {
      throw InputError(ErrorCode::kDims,
                       std::string("volume: size along ") + kAxisNames[axis] + " is 0");
    }
  }
  const std::size_t slice_limit = kMaxVoxels / size[0] / size[1];
  if (slice_limit < size[2]) {
    throw InputError(ErrorCode::kTooLarge, "volume: size " + std::to_string(size[0]) + " x " +
                                               std::to_string(size[1]) + " x " +
                                               std::to_string(size[2]) + " has more than " +
                                               std::to_string(kMaxVoxels) + " voxels");
  }
  return std::size_t{size[0]} * size[1] * size[2];
}

Mat3 checked_axes(const std::array<double, 4>& q) {
  const double norm = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(std::abs(norm - 1.0) <= 1e-3)) {
    throw InputError(ErrorCode::kDirection,
                     "volume: origin.orientation has norm " + to_text(norm) + ", not 1");
  }
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

template <class T>
void require_finite(const std::vector<T>& values) {
  std::size_t bad = 0;
  std::size_t first = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::isfinite(static_cast<double>(values[i]))) continue;
    if (bad++ == 0) first = i;
  }
  if (bad == 0) return;
  throw InputError(ErrorCode::kNonfinite, "volume: data has " + std::to_string(bad) +
                                              " values that are not finite, the first (" +
                                              to_text(static_cast<double>(values[first])) +
                                              ") at voxel " + std::to_string(first));
}

template <class T>
Voxels decoded(const RawVolume& raw, std::size_t count) {
  if (raw.data_size / sizeof(T) != count || raw.data_size % sizeof(T) != 0) {
    throw InputError(ErrorCode::kSizeMismatch, "volume: data has " + std::to_string(raw.data_size) +
                                                   " bytes, but " + std::to_string(count) +
                                                   " voxels of " + raw.encoding + " need " +
                                                   std::to_string(count * sizeof(T)));
  }
  std::vector<T> values(count);
  std::memcpy(values.data(), raw.data, raw.data_size);
  if (raw.is_bigendian && sizeof(T) > 1) {
    for (T& value : values) value = reversed_bytes(value);
  }
  return values;
}

Voxels decoded_voxels(const RawVolume& raw, std::size_t count) {
  if (raw.encoding == "8UC1") return decoded<std::uint8_t>(raw, count);
  if (raw.encoding == "16UC1") return decoded<std::uint16_t>(raw, count);
  if (raw.encoding == "16SC1") return decoded<std::int16_t>(raw, count);
  if (raw.encoding == "32SC1") return decoded<std::int32_t>(raw, count);
  if (raw.encoding == "32FC1") return decoded<float>(raw, count);
  if (raw.encoding == "64FC1") return decoded<double>(raw, count);
  throw InputError(ErrorCode::kEncoding, "volume: encoding '" + raw.encoding.substr(0, 40) +
                                             "' is not one of " + kEncodings);
}

Quantity checked_quantity(const std::string& text) {
  if (text.empty() || text == "density") return Quantity::kDensity;
  if (text == "hounsfield") return Quantity::kHounsfield;
  if (text == "label") return Quantity::kLabel;
  throw InputError(ErrorCode::kParam, "volume: quantity '" + text.substr(0, 40) +
                                          "' is not one of density hounsfield label");
}

void require_frame(const std::string& frame_id) {
  if (!frame_id.empty() && frame_id.size() <= kMaxNameLength && frame_id[0] != '/') return;
  throw InputError(ErrorCode::kFrame, "volume: header.frame_id '" + frame_id.substr(0, 40) +
                                          "' is empty, begins with a slash or is too long");
}

void check_header(const Volume& volume) {
  for (int axis = 0; axis < 3; ++axis) {
    const double spacing = volume.grid.spacing[axis];
    if (!(spacing >= kMinSpacing && spacing <= kMaxSpacing)) {
      throw InputError(ErrorCode::kSpacing, std::string("volume: spacing.") + kAxisNames[axis] +
                                                " is " + to_text(spacing) +
                                                " m, not between 1e-06 and 1 m");
    }
  }
  // Vertices are published as float32: farther away a tet could be rounded flat.
  if (!(volume.grid.origin.norm() <= kMaxDistance)) {
    throw InputError(ErrorCode::kDirection, "volume: origin.position is " +
                                                to_text(volume.grid.origin.norm()) +
                                                " m away, more than " + to_text(kMaxDistance));
  }
  if (!std::isfinite(volume.slope) || volume.slope == 0.0 || !std::isfinite(volume.intercept)) {
    throw InputError(ErrorCode::kParam, "volume: rescale_slope " + to_text(volume.slope) +
                                            " or rescale_intercept " + to_text(volume.intercept) +
                                            " is not a finite scale");
  }
  require_frame(volume.frame_id);
}

void check_values(const Volume& volume) {
  std::visit(
      [](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        if constexpr (std::is_floating_point_v<T>) require_finite(values);
      },
      volume.voxels);
  const std::array<double, 2> range = value_range(volume);
  if (!std::isfinite(range[0]) || !std::isfinite(range[1])) {
    throw InputError(ErrorCode::kNonfinite, "volume: values overflow after rescale_slope " +
                                                to_text(volume.slope) + " and rescale_intercept " +
                                                to_text(volume.intercept));
  }
}

}  // namespace

bool same_grid(const Grid& a, const Grid& b) {
  const double tolerance = 1e-3 * a.spacing.minCoeff();
  return a.size == b.size && (a.spacing - b.spacing).norm() <= tolerance &&
         (a.origin - b.origin).norm() <= tolerance && (a.axes - b.axes).norm() <= 1e-3;
}

std::array<double, 2> value_range(const Volume& volume) {
  std::array<double, 2> range = std::visit(
      [](const auto& values) {
        // Written out, because std::minmax_element does not vectorise.
        auto low = values[0], high = values[0];
        for (const auto value : values) {
          low = value < low ? value : low;
          high = value > high ? value : high;
        }
        return std::array<double, 2>{static_cast<double>(low), static_cast<double>(high)};
      },
      volume.voxels);
  for (double& value : range) value = volume.slope * value + volume.intercept;
  if (range[0] > range[1]) std::swap(range[0], range[1]);
  return range;
}

Volume decode_volume(const RawVolume& raw) {
  const std::size_t count = checked_voxel_count(raw.size);
  Volume volume;
  volume.grid = {raw.size, raw.spacing, raw.origin, checked_axes(raw.orientation)};
  volume.quantity = checked_quantity(raw.quantity);
  volume.slope = raw.slope;
  volume.intercept = raw.intercept;
  volume.frame_id = raw.frame_id;
  check_header(volume);
  volume.voxels = decoded_voxels(raw, count);
  check_values(volume);
  return volume;
}

void check_volume(const Volume& volume) {
  const std::size_t count = checked_voxel_count(volume.grid.size);
  check_header(volume);
  const std::size_t held = std::visit([](const auto& v) { return v.size(); }, volume.voxels);
  if (held != count) {
    throw InputError(ErrorCode::kSizeMismatch, "volume: data has " + std::to_string(held) +
                                                   " values for " + std::to_string(count) +
                                                   " voxels");
  }
  check_values(volume);
}

std::string encoding_name(const Voxels& voxels) {
  constexpr std::array<const char*, 6> names = {"8UC1",  "16UC1", "16SC1",
                                                "32SC1", "32FC1", "64FC1"};
  return names[voxels.index()];
}

std::string quantity_name(Quantity quantity) {
  switch (quantity) {
    case Quantity::kHounsfield: return "hounsfield";
    case Quantity::kLabel: return "label";
    case Quantity::kDensity: break;
  }
  return "density";
}

}  // namespace tissue
