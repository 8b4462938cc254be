# The libraries for programs of others: `find_package(Rubble)`, docs/reference/library.md.
#
#   lib/librubble_*.a           static archives
#   include/rubble              their public headers (RubblePublic.cmake); nothing else is promised
#   lib/cmake/Rubble            the CMake package; it finds itself from where it lies
install(DIRECTORY ${RUBBLE_PUBLIC_INCLUDE}/rubble DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(TARGETS ${RUBBLE_LIBRARIES}
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development)

include(CMakePackageConfigHelpers)
set(package ${CMAKE_INSTALL_LIBDIR}/cmake/Rubble)
set(RUBBLE_INCLUDE_FOLDER ${CMAKE_INSTALL_INCLUDEDIR})
set(RUBBLE_LIBRARY_FOLDER ${CMAKE_INSTALL_LIBDIR})
configure_package_config_file(cmake/RubbleConfig.cmake.in ${PROJECT_BINARY_DIR}/RubbleConfig.cmake
  INSTALL_DESTINATION ${package} PATH_VARS RUBBLE_INCLUDE_FOLDER RUBBLE_LIBRARY_FOLDER)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/RubbleConfigVersion.cmake
  COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/RubbleConfig.cmake ${PROJECT_BINARY_DIR}/RubbleConfigVersion.cmake
  DESTINATION ${package} COMPONENT development)
