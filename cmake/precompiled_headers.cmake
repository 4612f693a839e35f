# What nearly every file includes is compiled once for all libraries and once for all test
# programs. Off with -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON.
set(common <Eigen/Geometry> <Eigen/SparseCore> <algorithm> <functional> <map> <memory> <optional>
  <string> <vector>)
target_precompile_headers(tissue_base PRIVATE ${common})
set(sharing tissue_field tissue_lattice tissue_refine tissue_simulate tissue_study)
# A macro that only one shared library defines would make the headers of no use to the others.
set_target_properties(tissue_base ${sharing} PROPERTIES DEFINE_SYMBOL "")
foreach(library ${sharing})
  target_precompile_headers(${library} REUSE_FROM tissue_base)
endforeach()
if(TARGET test_base)
  target_precompile_headers(test_base PRIVATE ${common} <gtest/gtest.h>)
  foreach(test test_field test_lattice test_refine test_simulate test_study)
    target_precompile_headers(${test} REUSE_FROM test_base)
  endforeach()
endif()
