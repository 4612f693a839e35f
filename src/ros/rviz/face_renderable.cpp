#include "ros/rviz/face_renderable.h"

#include <OgreCamera.h>
#include <OgreHardwareBufferManager.h>
#include <OgreMaterialManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>

#include <algorithm>
#include <limits>

namespace tissue_ros {
namespace {

using tissue::Vec3f;

// Sources of a corner's place and normal, and of its colour: the first change with each cloud.
constexpr unsigned short kPlaces = 0, kColours = 1;

struct PlacedCorner {
  Vec3f place, normal;
};

// Writes all of a buffer.
template <class Fill>
void write(Ogre::HardwareBuffer& buffer, const Fill& fill) {
  fill(buffer.lock(Ogre::HardwareBuffer::HBL_DISCARD));
  buffer.unlock();
}

Ogre::HardwareVertexBufferSharedPtr vertex_buffer(std::size_t size, std::size_t count) {
  return Ogre::HardwareBufferManager::getSingleton().createVertexBuffer(
      size, count, Ogre::HardwareBuffer::HBU_DYNAMIC_WRITE_ONLY_DISCARDABLE);
}

}  // namespace

FaceRenderable::FaceRenderable(Ogre::SceneNode* node, const std::string& name) : node_(node) {
  material_ = Ogre::MaterialManager::getSingleton().create(
      name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME);
  setMaterial(material_);
  set_style(Style::kShaded, 1.0f);
  mRenderOp.operationType = Ogre::RenderOperation::OT_TRIANGLE_LIST;
  mRenderOp.vertexData = &vertex_data_;
  mRenderOp.indexData = &index_data_;
  mRenderOp.useIndexes = true;
  auto& declaration = *vertex_data_.vertexDeclaration;
  declaration.addElement(kPlaces, 0, Ogre::VET_FLOAT3, Ogre::VES_POSITION);
  declaration.addElement(kPlaces, sizeof(Vec3f), Ogre::VET_FLOAT3, Ogre::VES_NORMAL);
  declaration.addElement(kColours, 0, Ogre::VET_COLOUR_ABGR, Ogre::VES_DIFFUSE);
  node_->attachObject(this);
  setVisible(false);
}

FaceRenderable::~FaceRenderable() {
  node_->detachObject(this);
  mRenderOp.vertexData = nullptr;
  mRenderOp.indexData = nullptr;
  Ogre::MaterialManager::getSingleton().remove(material_->getHandle());
}

void FaceRenderable::set_style(Style style, float alpha) {
  alpha_ = alpha;
  Ogre::Technique* const technique = material_->getTechnique(0);
  technique->removeAllPasses();
  if (style != Style::kWireframe) {
    Ogre::Pass* const shaded = technique->createPass();
    shaded->setShadingMode(Ogre::SO_FLAT);
    shaded->setVertexColourTracking(Ogre::TVC_AMBIENT | Ogre::TVC_DIFFUSE);
    shaded->setSpecular(Ogre::ColourValue::Black);
    if (alpha < 1.0f) {
      shaded->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
      shaded->setDepthWriteEnabled(false);
    }
  }
  if (style != Style::kShaded) {
    Ogre::Pass* const wires = technique->createPass();
    wires->setPolygonMode(Ogre::PM_WIREFRAME);
    wires->setCullingMode(Ogre::CULL_NONE);
    if (style == Style::kBoth) {
      // Black, and a little nearer than the faces.
      wires->setAmbient(Ogre::ColourValue::Black);
      wires->setDiffuse(Ogre::ColourValue::Black);
      wires->setSpecular(Ogre::ColourValue::Black);
      wires->setDepthBias(1.0f, 1.0f);
    } else {
      wires->setLightingEnabled(false);
      wires->setShadingMode(Ogre::SO_FLAT);
    }
  }
}

void FaceRenderable::set_faces(const std::vector<SeenFace>& faces) {
  faces_ = faces;
  setVisible(!faces.empty());
  if (faces.empty()) return;
  constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t last = 0;
  for (const SeenFace& face : faces)
    last = std::max({last, face.corners[0], face.corners[1], face.corners[2]});
  std::vector<std::uint32_t> corner_at(last + 1, kNone);
  corners_.clear();
  for (const SeenFace& face : faces) {
    corner_at[face.corners[2]] = static_cast<std::uint32_t>(corners_.size());
    corners_.push_back(face.corners[2]);
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(3 * faces.size());
  for (std::uint32_t f = 0; f < faces.size(); ++f) {
    for (int i = 0; i < 2; ++i) {
      std::uint32_t& at = corner_at[faces[f].corners[i]];
      if (at == kNone) {
        at = static_cast<std::uint32_t>(corners_.size());
        corners_.push_back(faces[f].corners[i]);
      }
      indices.push_back(at);
    }
    indices.push_back(f);
  }
  index_data_.indexCount = indices.size();
  index_data_.indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, indices.size(),
      Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  index_data_.indexBuffer->writeData(0, indices.size() * sizeof(std::uint32_t), indices.data(),
                                     true);
  vertex_data_.vertexCount = corners_.size();
  vertex_data_.vertexBufferBinding->setBinding(
      kPlaces, vertex_buffer(sizeof(PlacedCorner), corners_.size()));
  vertex_data_.vertexBufferBinding->setBinding(kColours,
                                               vertex_buffer(sizeof(Ogre::RGBA), corners_.size()));
}

void FaceRenderable::set_places(const std::vector<Vec3f>& vertices) {
  if (faces_.empty()) return;
  Ogre::AxisAlignedBox box;
  write(*vertex_data_.vertexBufferBinding->getBuffer(kPlaces), [&](void* to) {
    auto* const corners = static_cast<PlacedCorner*>(to);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Vec3f& place = vertices[corners_[i]];
      Vec3f normal = Vec3f::UnitZ();
      if (i < faces_.size()) {
        const auto& c = faces_[i].corners;
        normal = (vertices[c[1]] - vertices[c[0]]).cross(place - vertices[c[0]]).normalized();
      }
      corners[i] = {place, normal};
      box.merge(Ogre::Vector3(place.x(), place.y(), place.z()));
    }
  });
  setBoundingBox(box);
  node_->needUpdate();
}

void FaceRenderable::set_colours(const std::vector<Colour>& colours) {
  if (faces_.empty()) return;
  write(*vertex_data_.vertexBufferBinding->getBuffer(kColours), [&](void* to) {
    auto* const corners = static_cast<Ogre::RGBA*>(to);
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      // What triangles only borrow has no say in how they look.
      const Colour& c = colours[std::min(i, colours.size() - 1)];
      corners[i] = Ogre::ColourValue(c[0], c[1], c[2], alpha_).getAsABGR();
    }
  });
}

Ogre::Real FaceRenderable::getBoundingRadius() const {
  return Ogre::Math::boundingRadiusFromAABB(mBox);
}

Ogre::Real FaceRenderable::getSquaredViewDepth(const Ogre::Camera* camera) const {
  return (camera->getDerivedPosition() - node_->_getDerivedPosition() - mBox.getCenter())
      .squaredLength();
}

}  // namespace tissue_ros
