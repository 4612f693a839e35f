#pragma once

#include "tissue/field/edit_volume.h"
#include "tissue/refine/build_mesh.h"

#include <boost/program_options.hpp>

#include <string>
#include <vector>

namespace tissue_tools {

/// What mesh_volume was asked for.
struct MeshVolumeArguments {
  std::string volume, mask, surface, output, stats, marching_cubes, scene;
  std::vector<std::string> paths;
  /// Part of the triangles of marching cubes to keep.
  double decimate = 1.0;
  std::vector<tissue::Tumour> tumours;
  /// 0: all. The mesh does not depend on it.
  int threads = 0;
  tissue::MeshOptions mesh;
};

boost::program_options::options_description mesh_volume_options();

/// Throws tissue::InputError that names the option and the value.
MeshVolumeArguments mesh_volume_arguments(const boost::program_options::variables_map& given);

}  // namespace tissue_tools
