#include "tissue/base/error.h"

#include <sstream>

namespace tissue {

const char* name(ErrorCode code) {
  switch (code) {
    case ErrorCode::kOk: return "OK";
    case ErrorCode::kSizeMismatch: return "E_SIZE_MISMATCH";
    case ErrorCode::kDims: return "E_DIMS";
    case ErrorCode::kTooLarge: return "E_TOO_LARGE";
    case ErrorCode::kSpacing: return "E_SPACING";
    case ErrorCode::kEncoding: return "E_ENCODING";
    case ErrorCode::kNonfinite: return "E_NONFINITE";
    case ErrorCode::kEmptySurface: return "E_EMPTY_SURFACE";
    case ErrorCode::kTooSmall: return "E_TOO_SMALL";
    case ErrorCode::kDirection: return "E_DIRECTION";
    case ErrorCode::kNonuniform: return "E_NONUNIFORM";
    case ErrorCode::kComplexity: return "E_COMPLEXITY";
    case ErrorCode::kFrame: return "E_FRAME";
    case ErrorCode::kN: return "E_N";
    case ErrorCode::kTooManyTets: return "E_TOO_MANY_TETS";
    case ErrorCode::kNTinit: return "E_NTINIT";
    case ErrorCode::kParam: return "E_PARAM";
    case ErrorCode::kBusy: return "E_BUSY";
    case ErrorCode::kPath: return "E_PATH";
    case ErrorCode::kFile: return "E_FILE";
    case ErrorCode::kMeshQuality: return "E_MESH_QUALITY";
    case ErrorCode::kDt: return "E_DT";
    case ErrorCode::kUnconstrained: return "E_UNCONSTRAINED";
    case ErrorCode::kConformity: return "E_CONFORMITY";
    case ErrorCode::kIo: return "E_IO";
    case ErrorCode::kNomem: return "E_NOMEM";
    case ErrorCode::kNoVolume: return "E_NO_VOLUME";
    case ErrorCode::kCancelled: return "E_CANCELLED";
    case ErrorCode::kScene: return "E_SCENE";
    case ErrorCode::kInternal: return "E_INTERNAL";
  }
  return "E_INTERNAL";
}

std::string to_text(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

}  // namespace tissue
