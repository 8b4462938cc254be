# The libraries for programs of others, as targets of this build: Rubble::kernel, robots, files and voids.
# `add_subdirectory(rubble)` gives them, and RubblePackage.cmake installs them: docs/reference/library.md.
#
# Public headers are copied to include/rubble of the build, with the prefix in their own includes, so that a program sees
# nothing but <rubble/...>. What a public header includes is public, too; tests/app/library_test.cpp compiles them all.
set(RUBBLE_PUBLIC_HEADERS
  io/mesh/stl_writer.h
  io/state/checkpoint_file.h
  io/state/pile_state_file.h
  io/state/track_file.h
  kernel/base/error.h
  kernel/base/hash.h
  kernel/base/math.h
  kernel/base/mesh.h
  kernel/base/portable_math.h
  kernel/base/random.h
  kernel/geometry/decompose.h
  kernel/geometry/hull.h
  kernel/geometry/simplify_hull.h
  kernel/model/assembly.h
  kernel/model/building.h
  kernel/model/everting_tube.h
  kernel/model/fines.h
  kernel/model/pile.h
  kernel/model/pile_state.h
  kernel/model/robot.h
  kernel/model/size_distribution.h
  kernel/model/surroundings.h
  kernel/model/track.h
  kernel/model/track_builder.h
  kernel/model/world_input.h
  kernel/robot/drive_commands.h
  kernel/robot/odometry.h
  kernel/robot/robot_run.h
  kernel/robot/step_rate.h
  kernel/settling/collapse_report.h
  kernel/settling/generator.h
  kernel/settling/settle.h
  kernel/settling/settle_checkpoint.h
  kernel/settling/track_recorder.h
  kernel/solver/sweep_figures.h
  kernel/world/world.h
  kernel/world/world_diagnostics.h
  kernel/world/world_rest.h
  kernel/world/world_robots.h
  kernel/world/world_snapshot.h
  kernel/world/world_structures.h
  scripting/robots/crawler.h
  scripting/robots/rover.h
  scripting/robots/snake.h
  scripting/robots/vine.h)
set(RUBBLE_LIBRARIES rubble_base rubble_kernel rubble_robots rubble_files)
if(TARGET rubble_voids)
  list(APPEND RUBBLE_LIBRARIES rubble_queries rubble_voids)
  list(APPEND RUBBLE_PUBLIC_HEADERS
    kernel/geometry/voxel_grid.h
    kernel/queries/queries.h
    kernel/voids/cell_clearance.h
    kernel/voids/cell_kinds.h
    kernel/voids/cell_runs.h
    kernel/voids/cell_slots.h
    kernel/voids/void_map.h
    kernel/voids/void_path.h
    kernel/voids/void_space.h
    kernel/voids/widest_path.h)
endif()

set(RUBBLE_PUBLIC_INCLUDE ${PROJECT_BINARY_DIR}/include)
set(script ${PROJECT_SOURCE_DIR}/cmake/WritePublicHeaders.cmake)
set(sources ${RUBBLE_PUBLIC_HEADERS})
list(TRANSFORM sources PREPEND ${PROJECT_SOURCE_DIR}/)
set(copies ${RUBBLE_PUBLIC_HEADERS})
list(TRANSFORM copies PREPEND ${RUBBLE_PUBLIC_INCLUDE}/rubble/)
add_custom_command(OUTPUT ${RUBBLE_PUBLIC_INCLUDE}/written BYPRODUCTS ${copies}
  COMMAND ${CMAKE_COMMAND} "-DHEADERS=${RUBBLE_PUBLIC_HEADERS}" -DFROM=${PROJECT_SOURCE_DIR} -DTO=${RUBBLE_PUBLIC_INCLUDE}/rubble
    -P ${script}
  COMMAND ${CMAKE_COMMAND} -E touch ${RUBBLE_PUBLIC_INCLUDE}/written
  DEPENDS ${sources} ${script}
  COMMENT "Writing the public headers" VERBATIM)
add_custom_target(rubble_public_headers ALL DEPENDS ${RUBBLE_PUBLIC_INCLUDE}/written)

# rubble_public(NAME LIBRARY...): neither our warnings nor our include directories reach a program of others.
function(rubble_public name)
  add_library(rubble_public_${name} INTERFACE)
  add_library(Rubble::${name} ALIAS rubble_public_${name})
  add_dependencies(rubble_public_${name} rubble_public_headers)
  target_include_directories(rubble_public_${name} INTERFACE ${RUBBLE_PUBLIC_INCLUDE})
  target_compile_features(rubble_public_${name} INTERFACE cxx_std_17)
  # Inline functions of the headers are compiled into the program: with other roundings there, results would not be
  # those of `rubble`.
  target_compile_options(rubble_public_${name} INTERFACE -ffp-contract=off)
  foreach(library IN LISTS ARGN)
    target_link_libraries(rubble_public_${name} INTERFACE $<LINK_ONLY:${library}>)
  endforeach()
endfunction()
rubble_public(kernel rubble_kernel)
rubble_public(robots rubble_robots rubble_kernel)
rubble_public(files rubble_files rubble_kernel)
if(TARGET rubble_voids)
  rubble_public(voids rubble_voids)
endif()
