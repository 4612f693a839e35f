#pragma once

#include "tissue/base/error.h"
#include "tissue/base/tet_mesh.h"
#include "tissue/field/volume.h"
#include "tissue/simulate/scene.h"

#include <sensor_msgs/PointCloud2.h>
#include <soft_tissue_sim/MeshStatistics.h>
#include <soft_tissue_sim/Result.h>
#include <soft_tissue_sim/SimulationStatus.h>
#include <soft_tissue_sim/TetMesh.h>
#include <soft_tissue_sim/Volume.h>

namespace tissue_ros {

/// A larger message cuts its subscriber off for good.
constexpr std::size_t kMaxMessageBytes = 1000000000;

/// No name that comes in a message is longer.
constexpr std::size_t kMaxNameLength = 256;

/// What a claimed size may cost at most.
constexpr std::size_t kMaxMeshTets = 100000000;

/// Throws tissue::InputError as tissue::decode_volume does.
tissue::Volume from_message(const soft_tissue_sim::Volume& message);
/// The header's stamp is left at 0.
soft_tissue_sim::Volume to_message(const tissue::Volume& volume);

/// Copies after every length has been checked against every other. Throws tissue::InputError
/// E_SIZE_MISMATCH, E_TOO_LARGE or E_FRAME, and what tissue::check_mesh throws.
tissue::TetMesh from_message(const soft_tissue_sim::TetMesh& message);
soft_tissue_sim::TetMesh to_message(const tissue::TetMesh& mesh);
soft_tissue_sim::MeshStatistics to_message(const tissue::MeshStatistics& statistics);

soft_tissue_sim::Result to_message(tissue::ErrorCode code, const std::string& sentence);

/// x y z density level displacement, all float32, in mesh vertex order; `levels` is the highest of
/// each vertex's tets, displacement the length by which it has moved [m].
sensor_msgs::PointCloud2 cloud_message(const tissue::Body& body, const tissue::State& state,
                                       const std::vector<std::uint8_t>& levels);

/// Where the points of such a cloud are, or of any that begins with x y z in float32 [m]. Throws
/// tissue::InputError: E_ENCODING for another cloud, E_SIZE_MISMATCH if it is shorter than it says,
/// E_NONFINITE for a place that is not finite.
std::vector<tissue::Vec3f> places_in(const sensor_msgs::PointCloud2& cloud);

/// How a scene is and what its last step did. Header, mesh and counters are left open.
soft_tissue_sim::SimulationStatus to_message(const tissue::SceneDescription& scene,
                                             const std::vector<tissue::EffectCost>& costs,
                                             const tissue::DeformationQuality& quality,
                                             const tissue::StepReport& last_step);

/// The highest level of the tets at each vertex.
std::vector<std::uint8_t> vertex_levels(const tissue::TetMesh& mesh);

/// The frame without the slash with which some drivers begin it.
std::string plain_frame(const std::string& frame_id);

}  // namespace tissue_ros
