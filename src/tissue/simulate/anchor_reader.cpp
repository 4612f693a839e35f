#include "anchor_reader.h"

#include <cstdlib>

namespace tissue {
namespace {

constexpr double kFarthest = 1e3;

// Metres, or with a percent sign a fraction of the bounding box.
Coordinate coordinate_from(const YamlReader& reader) {
  const std::string word = reader.word();
  if (word.back() != '%') return {reader.number(-kFarthest, kFarthest), false};
  char* end = nullptr;
  const double percent = std::strtod(word.c_str(), &end);
  if (end != &word.back() || !(percent >= 0.0 && percent <= 100.0)) {
    reader.refuse(ErrorCode::kParam, "'" + word + "' is not within 0% to 100%");
  }
  return {percent / 100.0, true};
}

CoordinateTriple triple_from(const YamlReader& reader) {
  const std::vector<YamlReader> entries = reader.entries();
  if (entries.size() != 3) reader.refuse("is not a place [x, y, z]");
  return {coordinate_from(entries[0]), coordinate_from(entries[1]), coordinate_from(entries[2])};
}

PlaneAnchor plane_from(const YamlReader& reader) {
  reader.require_keys({"axis", "below", "above", "stiffness"});
  PlaneAnchor plane;
  const std::string axis = reader.at("axis").word();
  if (axis != "x" && axis != "y" && axis != "z") {
    reader.at("axis").refuse("'" + axis + "' is not x, y or z");
  }
  plane.axis = axis[0] - 'x';
  if (reader.has("below") == reader.has("above")) {
    reader.refuse("needs either below or above");
  }
  if (reader.has("below")) plane.below = coordinate_from(reader.at("below"));
  if (reader.has("above")) plane.above = coordinate_from(reader.at("above"));
  if (reader.has("stiffness")) plane.stiffness = reader.at("stiffness").number(0.0, 1e12, true);
  return plane;
}

Anchor anchor_from(const YamlReader& reader) {
  reader.require_keys({"plane", "box", "sphere", "label", "vertices"});
  if (reader.members().size() != 1) reader.refuse("is not one anchor");
  if (reader.has("plane")) return plane_from(reader.at("plane"));
  if (reader.has("box")) {
    reader.at("box").require_keys({"low", "high"});
    return BoxAnchor{triple_from(reader.at("box").at("low")),
                     triple_from(reader.at("box").at("high"))};
  }
  if (reader.has("sphere")) {
    reader.at("sphere").require_keys({"centre", "radius"});
    return SphereAnchor{triple_from(reader.at("sphere").at("centre")),
                        coordinate_from(reader.at("sphere").at("radius"))};
  }
  if (reader.has("label")) return LabelAnchor{reader.at("label").number(0.0, kFarthest)};
  VertexAnchor anchor;
  for (const YamlReader& entry : reader.at("vertices").entries()) {
    const double number = entry.number(0.0, 4294967295.0);
    anchor.vertices.push_back(static_cast<std::uint32_t>(number));
    if (number != anchor.vertices.back()) {
      entry.refuse(ErrorCode::kParam, to_text(number) + " is not the number of a vertex");
    }
  }
  return anchor;
}

}  // namespace

std::vector<Anchor> anchors_from(const YamlReader& reader) {
  std::vector<Anchor> anchors;
  for (const YamlReader& entry : reader.entries()) anchors.push_back(anchor_from(entry));
  return anchors;
}

}  // namespace tissue
