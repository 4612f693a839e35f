#include "ros/rviz/face_renderable.h"

#include <OgreCamera.h>
#include <OgreGpuProgramParams.h>
#include <OgreHardwareBufferManager.h>
#include <OgreHighLevelGpuProgram.h>
#include <OgreHighLevelGpuProgramManager.h>
#include <OgreMaterialManager.h>
#include <OgreSceneNode.h>
#include <OgreTechnique.h>

#include <algorithm>
#include <array>

namespace tissue_ros {
namespace {

using tissue::Vec3f;

// Sources of a corner's place and normal, of its colour, and of what its face's edges are told
// from: the first change with each cloud.
constexpr unsigned short kPlaces = 0, kColours = 1, kKinds = 2;

struct PlacedCorner {
  Vec3f place, normal;
};

// Of two of the three kinds of corners, 0 or 1; the third's is what is left.
using Weights = std::array<std::int16_t, 2>;

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

// Lines cost a renderer without hardware several times what their faces cost: edges are where one
// of the three weights of a face's corners vanishes.
constexpr char kLitCorner[] = R"(#version 120
uniform mat4 clip_from_object, view_from_object;
uniform vec4 ambient, diffuse, to_light;
uniform float is_lit;
varying vec2 weights;
void main() {
  vec3 normal = normalize(mat3(view_from_object) * gl_Normal);
  vec4 light = ambient + max(dot(normal, to_light.xyz), 0.0) * diffuse;
  gl_FrontColor = vec4(mix(vec3(1.0), light.rgb, is_lit) * gl_Color.rgb, gl_Color.a);
  gl_BackColor = gl_FrontColor;
  weights = gl_MultiTexCoord0.xy;
  gl_Position = clip_from_object * gl_Vertex;
})";
constexpr char kEdges[] = R"(#version 120
uniform float is_wireframe;
varying vec2 weights;
void main() {
  vec3 all = vec3(weights, 1.0 - weights.x - weights.y);
  vec3 change = max(fwidth(all), vec3(1e-6));
  vec3 pixels = all / change;
  float line = 1.0 - smoothstep(0.3, 1.0, min(pixels.x, min(pixels.y, pixels.z)));
  // Faces of a few pixels would be nothing but edges.
  float height = 1.0 / max(change.x, max(change.y, change.z));
  line *= max(is_wireframe, smoothstep(1.5, 7.0, height));
  if (is_wireframe * (1.0 - line) > 0.5) discard;
  gl_FragColor = vec4(gl_Color.rgb * (1.0 - line * (1.0 - is_wireframe)), gl_Color.a);
})";

// Of what every pass knows that shows edges.
constexpr char kCornerProgram[] = "soft_tissue_sim/lit_corner",
               kEdgeProgram[] = "soft_tissue_sim/edges";

void provide(const char* name, const char* source, Ogre::GpuProgramType type) {
  auto& manager = Ogre::HighLevelGpuProgramManager::getSingleton();
  if (manager.resourceExists(name)) return;
  manager
      .createProgram(name, Ogre::ResourceGroupManager::DEFAULT_RESOURCE_GROUP_NAME, "glsl", type)
      ->setSource(source);
}

void show_edges(Ogre::Pass* pass, bool is_wireframe) {
  using Parameters = Ogre::GpuProgramParameters;
  provide(kCornerProgram, kLitCorner, Ogre::GPT_VERTEX_PROGRAM);
  provide(kEdgeProgram, kEdges, Ogre::GPT_FRAGMENT_PROGRAM);
  pass->setVertexProgram(kCornerProgram);
  const auto corner = pass->getVertexProgramParameters();
  corner->setNamedAutoConstant("clip_from_object", Parameters::ACT_WORLDVIEWPROJ_MATRIX);
  corner->setNamedAutoConstant("view_from_object", Parameters::ACT_WORLDVIEW_MATRIX);
  corner->setNamedAutoConstant("ambient", Parameters::ACT_AMBIENT_LIGHT_COLOUR);
  corner->setNamedAutoConstant("diffuse", Parameters::ACT_LIGHT_DIFFUSE_COLOUR, 0);
  corner->setNamedAutoConstant("to_light", Parameters::ACT_LIGHT_POSITION_VIEW_SPACE, 0);
  corner->setNamedConstant("is_lit", is_wireframe ? 0.0f : 1.0f);
  pass->setFragmentProgram(kEdgeProgram);
  pass->getFragmentProgramParameters()->setNamedConstant("is_wireframe",
                                                         is_wireframe ? 1.0f : 0.0f);
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
  declaration.addElement(kKinds, 0, Ogre::VET_SHORT2, Ogre::VES_TEXTURE_COORDINATES);
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
  Ogre::Pass* const pass = technique->createPass();
  pass->setShadingMode(Ogre::SO_FLAT);
  pass->setVertexColourTracking(Ogre::TVC_AMBIENT | Ogre::TVC_DIFFUSE);
  pass->setSpecular(Ogre::ColourValue::Black);
  if (style == Style::kWireframe) pass->setCullingMode(Ogre::CULL_NONE);
  if (style != Style::kShaded) show_edges(pass, style == Style::kWireframe);
  if (style != Style::kWireframe && alpha < 1.0f) {
    pass->setSceneBlending(Ogre::SBT_TRANSPARENT_ALPHA);
    pass->setDepthWriteEnabled(false);
  }
}

void FaceRenderable::set_faces(const std::vector<SeenFace>& faces) {
  faces_ = faces;
  setVisible(!faces.empty());
  if (faces.empty()) return;
  corners_ = corners_of(faces);
  const std::vector<std::uint32_t>& indices = corners_.indices;
  index_data_.indexCount = indices.size();
  index_data_.indexBuffer = Ogre::HardwareBufferManager::getSingleton().createIndexBuffer(
      Ogre::HardwareIndexBuffer::IT_32BIT, indices.size(),
      Ogre::HardwareBuffer::HBU_STATIC_WRITE_ONLY);
  index_data_.indexBuffer->writeData(0, indices.size() * sizeof(std::uint32_t), indices.data(),
                                     true);
  const std::size_t count = corners_.vertices.size();
  vertex_data_.vertexCount = count;
  vertex_data_.vertexBufferBinding->setBinding(kPlaces, vertex_buffer(sizeof(PlacedCorner), count));
  vertex_data_.vertexBufferBinding->setBinding(kColours, vertex_buffer(sizeof(Ogre::RGBA), count));
  vertex_data_.vertexBufferBinding->setBinding(kKinds, vertex_buffer(sizeof(Weights), count));
  write(*vertex_data_.vertexBufferBinding->getBuffer(kKinds), [&](void* to) {
    auto* const weights = static_cast<Weights*>(to);
    for (std::size_t i = 0; i < count; ++i)
      weights[i] = {static_cast<std::int16_t>(corners_.kinds[i] == 0),
                    static_cast<std::int16_t>(corners_.kinds[i] == 1)};
  });
}

void FaceRenderable::set_places(const std::vector<Vec3f>& vertices) {
  if (faces_.empty()) return;
  Ogre::AxisAlignedBox box;
  write(*vertex_data_.vertexBufferBinding->getBuffer(kPlaces), [&](void* to) {
    auto* const corners = static_cast<PlacedCorner*>(to);
    for (std::size_t i = 0; i < corners_.vertices.size(); ++i) {
      const Vec3f& place = vertices[corners_.vertices[i]];
      Vec3f normal = Vec3f::UnitZ();
      if (i < faces_.size()) {
        const auto& c = faces_[i].corners;
        normal =
            (vertices[c[1]] - vertices[c[0]]).cross(vertices[c[2]] - vertices[c[0]]).normalized();
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
    for (std::size_t i = 0; i < corners_.vertices.size(); ++i) {
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
