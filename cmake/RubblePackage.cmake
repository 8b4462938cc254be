# The libraries for programs of others: `find_package(Rubble)`, docs/reference/library.md.
#
#   lib/librubble_*.a           static archives
#   include/rubble/kernel, io   their public headers; whatever is not listed here may change at any time
#   lib/cmake/Rubble            the CMake package; it finds itself from where it lies
#
# What a public header includes is public, too: tests/app/library_test.cpp compiles them all from there.
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
  kernel/settling/collapse_report.h
  kernel/settling/generator.h
  kernel/settling/settle.h
  kernel/settling/settle_checkpoint.h
  kernel/settling/track_recorder.h
  kernel/world/world.h
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
    kernel/voids/void_map.h
    kernel/voids/void_path.h
    kernel/voids/void_space.h
    kernel/voids/widest_path.h)
endif()

foreach(header IN LISTS RUBBLE_PUBLIC_HEADERS)
  get_filename_component(folder ${header} DIRECTORY)
  install(FILES ${header} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/rubble/${folder} COMPONENT development)
endforeach()
install(TARGETS ${RUBBLE_LIBRARIES}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)

include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Rubble)
set(RUBBLE_INCLUDE_FOLDER ${CMAKE_INSTALL_INCLUDEDIR}/rubble)
set(RUBBLE_LIBRARY_FOLDER ${CMAKE_INSTALL_LIBDIR})
configure_package_config_file(cmake/RubbleConfig.cmake.in ${CMAKE_BINARY_DIR}/RubbleConfig.cmake
  INSTALL_DESTINATION ${package} PATH_VARS RUBBLE_INCLUDE_FOLDER RUBBLE_LIBRARY_FOLDER)
write_basic_package_version_file(${CMAKE_BINARY_DIR}/RubbleConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_BINARY_DIR}/RubbleConfig.cmake ${CMAKE_BINARY_DIR}/RubbleConfigVersion.cmake
  DESTINATION ${package} COMPONENT development)
