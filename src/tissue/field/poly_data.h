#pragma once

#include "tissue/field/triangle_surface.h"

#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

namespace tissue {

using PolyData = vtkSmartPointer<vtkPolyData>;

PolyData poly_of(const TriangleSurface& surface);

/// Strips and polygons become triangles, and points at the same place one.
TriangleSurface surface_from(vtkPolyData* poly);

}  // namespace tissue
