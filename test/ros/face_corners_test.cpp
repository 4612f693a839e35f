// The corners with which rviz's display draws faces.
#include "ros/face_corners.h"
#include "support/bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>

namespace {

using namespace tissue_ros;

TEST(FaceCorners, EachFaceHasOneOfItsOwnAndOneOfEachKind) {
  const tissue::TetMesh mesh = tissue_test::refined_ball(0.012);
  OpenedMesh::Faces seen = OpenedMesh(mesh).faces({1, 0.5, false});
  std::vector<SeenFace> faces = seen.hull;
  faces.insert(faces.end(), seen.cut.begin(), seen.cut.end());
  ASSERT_GT(faces.size(), 500u);
  ASSERT_GT(seen.cut.size(), 50u);
  const FaceCorners corners = corners_of(faces);
  ASSERT_EQ(corners.indices.size(), 3 * faces.size());
  ASSERT_EQ(corners.kinds.size(), corners.vertices.size());
  for (std::size_t f = 0; f < faces.size(); ++f) {
    // Flat shading takes what it shows from a triangle's last corner.
    EXPECT_EQ(corners.indices[3 * f + 2], f);
    std::array<int, 3> kinds = {0, 0, 0};
    tissue::Triangle drawn;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t corner = corners.indices[3 * f + i];
      ASSERT_LT(corner, corners.vertices.size());
      ++kinds.at(corners.kinds[corner]);
      drawn[i] = corners.vertices[corner];
    }
    EXPECT_EQ(kinds, (std::array<int, 3>{1, 1, 1}));
    // Seen from outside counter-clockwise still, whichever comes first.
    std::rotate(drawn.begin(), std::find(drawn.begin(), drawn.end(), faces[f].corners[0]),
                drawn.end());
    EXPECT_EQ(drawn, faces[f].corners);
  }
  // What they are for: most corners are shared.
  EXPECT_LT(4 * corners.vertices.size(), 5 * faces.size());
  std::printf("%zu corners of %zu faces\n", corners.vertices.size(), faces.size());
}

TEST(FaceCorners, WithoutFacesThereAreNone) { EXPECT_TRUE(corners_of({}).vertices.empty()); }

}  // namespace
