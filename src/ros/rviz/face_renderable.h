#pragma once

#include "ros/colours.h"
#include "ros/face_corners.h"

#include <OgreSimpleRenderable.h>

#include <vector>

namespace Ogre {
class SceneManager;
class SceneNode;
}  // namespace Ogre

namespace tissue_ros {

/// Triangles between vertices that move, each in its own colour, with or without its edges.
class FaceRenderable : public Ogre::SimpleRenderable {
 public:
  enum class Style { kShaded, kWireframe, kBoth };

  /// Below `node`, invisible as long as it has no faces. `name`: of its material, which no other
  /// may have.
  FaceRenderable(Ogre::SceneNode* node, const std::string& name);
  ~FaceRenderable() override;
  FaceRenderable(const FaceRenderable&) = delete;
  FaceRenderable& operator=(const FaceRenderable&) = delete;

  /// `alpha`: of the colours that are set next; 1 hides what is behind.
  void set_style(Style style, float alpha);
  /// Which triangles there are; to be followed by set_places() and set_colours().
  void set_faces(const std::vector<SeenFace>& faces);
  /// Where the vertices of the faces are.
  void set_places(const std::vector<tissue::Vec3f>& vertices);
  /// One for each face.
  void set_colours(const std::vector<Colour>& colours);

  Ogre::Real getBoundingRadius() const override;
  Ogre::Real getSquaredViewDepth(const Ogre::Camera* camera) const override;

 private:
  Ogre::SceneNode* node_;
  float alpha_ = 1.0f;
  Ogre::MaterialPtr material_;
  FaceCorners corners_;
  std::vector<SeenFace> faces_;
  Ogre::VertexData vertex_data_;
  Ogre::IndexData index_data_;
};

}  // namespace tissue_ros
