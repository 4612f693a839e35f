tissue_test(test_base LIBRARIES tissue_test_support tissue_simulate tissue_mesh_file SOURCES
  base/layering_test.cpp base/mesh_checks_test.cpp base/mesh_file_test.cpp base/safe_path_test.cpp
  base/topology_test.cpp)
tissue_test(test_field LIBRARIES tissue_test_support tissue_triangle_surface tissue_dicom_writer SOURCES
  field/density_test.cpp field/dicom_test.cpp field/edit_volume_test.cpp field/implicit_surface_test.cpp
  field/read_volume_test.cpp field/triangle_surface_test.cpp field/volume_test.cpp)
tissue_test(test_lattice LIBRARIES tissue_test_support SOURCES
  lattice/stencils_test.cpp lattice/stuffing_test.cpp)
tissue_test(test_refine LIBRARIES tissue_test_support SOURCES
  refine/build_mesh_test.cpp refine/levels_test.cpp refine/methods_test.cpp
  refine/project_boundary_test.cpp refine/refine_test.cpp
  refine/splitting_test.cpp)
tissue_test(test_simulate LIBRARIES tissue_test_support tissue_simulate SOURCES
  simulate/constitutive_test.cpp simulate/contact_test.cpp simulate/contact_torture_test.cpp
  simulate/contrast_test.cpp simulate/dynamics_test.cpp simulate/elasticity_test.cpp
  simulate/force_feedback_test.cpp simulate/force_loop_test.cpp simulate/multigrid_test.cpp
  simulate/near_incompressibility_test.cpp simulate/node_surface_test.cpp simulate/playback_test.cpp
  simulate/probe_points_test.cpp simulate/push_field_test.cpp simulate/rigid_inclusions_test.cpp simulate/scene_file_test.cpp
  simulate/scene_test.cpp simulate/soft_holds_test.cpp simulate/solid_scene_test.cpp
  simulate/solutions_test.cpp simulate/torture_test.cpp)
# Effects' files once more, with every call in them counted; where calls can be told apart by the
# linker's map, and no sanitizer counts on being called first.
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND NOT CMAKE_CXX_FLAGS MATCHES "-fsanitize=")
  set(counted ${TISSUE_EFFECTS})
  foreach(file averaged_volume contact_energy damping dynamics fold_guard gravity inertia
      rigid_inclusions rigid_system squared_system)
    list(APPEND counted src/tissue/simulate/${file}.cpp)
  endforeach()
  list(TRANSFORM counted REPLACE "^src" "${CMAKE_SOURCE_DIR}/src")
  set_source_files_properties(${counted} PROPERTIES
    COMPILE_OPTIONS "-finstrument-functions;-finstrument-functions-exclude-file-list=/usr/,.h")
  tissue_test(test_effect_costs LIBRARIES tissue_test_support tissue_simulate tissue_yaml SOURCES
    simulate/effect_costs_test.cpp ${counted})
  set(map ${CMAKE_CURRENT_BINARY_DIR}/test_effect_costs.map)
  target_compile_definitions(test_effect_costs PRIVATE TISSUE_LINK_MAP="${map}")
  target_link_options(test_effect_costs PRIVATE -no-pie -Wl,-Map=${map})
endif()
tissue_test(test_study LIBRARIES tissue_test_support tissue_study SOURCES
  study/strain_mesh_test.cpp study/study_test.cpp)
tissue_test(test_tools LIBRARIES tissue_test_support SOURCES
  tools/accuracy_study_test.cpp tools/mesh_volume_test.cpp tools/run_scene_test.cpp)
target_compile_definitions(test_tools PRIVATE
  ACCURACY_STUDY="$<TARGET_FILE:accuracy_study>" MESH_VOLUME="$<TARGET_FILE:mesh_volume>" RUN_SCENE="$<TARGET_FILE:run_scene>")
# Those that take longest begin first.
set_tests_properties(test_simulate PROPERTIES COST 100)
set_tests_properties(test_refine PROPERTIES COST 50)
tissue_test(test_fuzz_corpus LIBRARIES tissue_field tissue_mesh_file tissue_simulate SOURCES
  fuzz/corpus_test.cpp fuzz/targets.cpp)

# scripts/fuzz sets the sanitizers of everything; this adds libFuzzer's main function.
option(TISSUE_FUZZ "Build the fuzzer, with clang" OFF)
if(TISSUE_FUZZ)
  # Without ITK, whose headers refuse clang here.
  add_executable(fuzz EXCLUDE_FROM_ALL fuzz/fuzz.cpp fuzz/targets.cpp ${CMAKE_SOURCE_DIR}/src/tissue/field/volume.cpp)
  target_include_directories(fuzz PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
  target_link_libraries(fuzz tissue_mesh_file tissue_simulate)
  target_link_options(fuzz PRIVATE -fsanitize=fuzzer)
  set_target_properties(fuzz PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR})
endif()
