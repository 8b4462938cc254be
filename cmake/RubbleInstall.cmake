# `cmake --install`, and the Debian packages that CPack makes of what it installs: `rubble`, and
# `librubble-dev` of the component "development" (RubblePackage.cmake).
#
#   bin/rubble                             finds its assets in ../share/rubble, wherever it lies
#   share/rubble/assets, scripts, editor   bundled packs; missions; annotations for editors
#   share/man, bash-completion, zsh        made by the program from its own declarations
#   share/doc/rubble                       documents, without their pictures
include(GNUInstallDirs)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
# Only what was asked for is built, not the tests.
set(CMAKE_SKIP_INSTALL_ALL_DEPENDENCY ON)

set(share ${PROJECT_BINARY_DIR}/share)
add_custom_command(OUTPUT ${share}/rubble.lua
  COMMAND ${CMAKE_COMMAND} "-DPROGRAM=${CMAKE_CROSSCOMPILING_EMULATOR};$<TARGET_FILE:rubble>" -DOUTPUT=${share}
    -P ${PROJECT_SOURCE_DIR}/cmake/WriteShare.cmake
  DEPENDS rubble ${PROJECT_SOURCE_DIR}/cmake/WriteShare.cmake
  COMMENT "Writing manual pages, completions and annotations" VERBATIM)
add_custom_target(rubble_share ALL DEPENDS ${share}/rubble.lua)
add_dependencies(program rubble_share)

set(data ${CMAKE_INSTALL_DATADIR}/rubble)
install(TARGETS rubble RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
foreach(pack concrete residential parking bridge victims)
  install(DIRECTORY ${PROJECT_BINARY_DIR}/assets/${pack} DESTINATION ${data}/assets)
endforeach()
install(FILES assets/materials.lua DESTINATION ${data}/assets)
install(DIRECTORY scripts DESTINATION ${data} PATTERN "*.golden.json" EXCLUDE)
install(FILES ${share}/rubble.lua DESTINATION ${data}/editor)
install(DIRECTORY ${share}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
install(FILES ${share}/bash/rubble DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
install(FILES ${share}/zsh/_rubble DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} FILES_MATCHING PATTERN "*.md"
  PATTERN "pictures" EXCLUDE)
install(FILES ${share}/copyright ${share}/changelog.gz DESTINATION ${CMAKE_INSTALL_DOCDIR})

include(RubblePackage)
install(FILES ${share}/copyright ${share}/changelog.gz
  DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/librubble-dev COMPONENT development)

set(CPACK_GENERATOR DEB)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_ALL program development)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME rubble)
set(CPACK_PACKAGE_NAME rubble)
set(RUBBLE_MAINTAINER "The Rubble authors <rubble@example.org>" CACHE STRING
  "Who answers for the Debian package: NAME <ADDRESS>")
set(CPACK_PACKAGE_CONTACT "${RUBBLE_MAINTAINER}")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
# What dpkg-shlibdeps cannot see: libEGL and SDL are opened at run time, where the device `gl` draws and a window is shown.
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "libsdl2-2.0-0")
set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS "libegl1, libegl-mesa0, libgl1-mesa-dri, libgl1")
# It knows the libraries of this machine alone: tools/package_arm64.sh says what those of another are in.
set(RUBBLE_PACKAGE_DEPENDS "" CACHE STRING "Packages of the program's libraries, instead of what dpkg-shlibdeps finds")
if(RUBBLE_PACKAGE_DEPENDS)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_SHLIBDEPS OFF)
  set(CPACK_DEBIAN_PROGRAM_PACKAGE_DEPENDS "${RUBBLE_PACKAGE_DEPENDS}")
endif()
if(CMAKE_CROSSCOMPILING AND CMAKE_SYSTEM_PROCESSOR STREQUAL "aarch64")
  set(CPACK_DEBIAN_PACKAGE_ARCHITECTURE arm64)
endif()
set(CPACK_COMPONENT_PROGRAM_DESCRIPTION "simulator of collapsed structures for mapping robots
Rubble makes data sets for people who build mapping and autonomy for
search-and-rescue robots. A seed and a one-page Lua mission give a
physically settled pile of debris, a camera flight through its voids,
exact RGB-D frames, an MRPT rawlog, a ROS bag and the ground truth: the
same bits every time, on a machine without a graphics card.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME librubble-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "libsimbody-dev, libxxhash-dev, libssl-dev, libembree-dev")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "simulator of collapsed structures - libraries and headers
Rubble makes data sets for people who build mapping and autonomy for
search-and-rescue robots. These are its kernel as static libraries with
their headers and a CMake package: piles of debris and how they settle,
rays and nearest points, maps of voids, and the files of the program.")
include(CPack)
