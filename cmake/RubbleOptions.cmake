# The one place for compiler flags. Every target of ours links rubble_options.

set(CMAKE_CXX_STANDARD 17)  # Simbody 3.7's headers do not compile as C++20
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
set_property(GLOBAL PROPERTY USE_FOLDERS ON)

# Warnings are errors for those who develop: the presets but `release`, and wherever CI is set. Another compiler
# warns of other things, which must not stop those who only build.
if(NOT DEFINED CMAKE_COMPILE_WARNING_AS_ERROR AND "$ENV{CI}")
  set(CMAKE_COMPILE_WARNING_AS_ERROR ON CACHE BOOL "Warnings are errors")
endif()

find_package(Threads REQUIRED)

# A compiler cache, where one is installed: an object that was compiled before, here or in another checkout, is copied.
# What it must overlook are the precompiled header's name and time.
find_program(RUBBLE_CCACHE ccache)
if(RUBBLE_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
  foreach(language C CXX)
    set(CMAKE_${language}_COMPILER_LAUNCHER ${CMAKE_COMMAND} -E env
      CCACHE_BASEDIR=${PROJECT_SOURCE_DIR} CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime,include_file_ctime
      ${RUBBLE_CCACHE})
  endforeach()
endif()

add_library(rubble_options INTERFACE)
target_include_directories(rubble_options INTERFACE ${PROJECT_SOURCE_DIR})
target_link_libraries(rubble_options INTERFACE Threads::Threads)
target_compile_options(rubble_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor
  # The same bits from every compiler: no fused multiply-add unless written out.
  -ffp-contract=off)

# For what results depend on. GCC 12 fuses a*b +- c into vfmaddsub when it vectorizes for a processor
# that has it, whatever -ffp-contract says; the solver's wide loops are written out anyway.
add_library(rubble_exact INTERFACE)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  target_compile_options(rubble_exact INTERFACE -fno-tree-vectorize)
endif()

set(RUBBLE_SANITIZE "" CACHE STRING "address,undefined or thread; empty: none")
if(RUBBLE_SANITIZE)
  target_compile_options(rubble_options INTERFACE
    -fsanitize=${RUBBLE_SANITIZE} -fno-omit-frame-pointer -g1)
  target_link_options(rubble_options INTERFACE -fsanitize=${RUBBLE_SANITIZE})
  if(RUBBLE_SANITIZE MATCHES "undefined")
    target_compile_options(rubble_options INTERFACE -fno-sanitize-recover=undefined)
  endif()
endif()

# ThreadSanitizer calls its library at every access to memory that the optimizer leaves. The preset compiles tests
# quickly, by -O1; what they spend their time in is worth more.
function(rubble_optimize_for_thread_sanitizer)
  if(RUBBLE_SANITIZE STREQUAL "thread")
    foreach(target IN LISTS ARGN)
      target_compile_options(${target} PRIVATE -O2)
    endforeach()
  endif()
endfunction()

# `make fuzz`: every function reports what it reaches to libFuzzer.
option(RUBBLE_FUZZ "Build the fuzz targets alone, by clang" OFF)
if(RUBBLE_FUZZ)
  target_compile_options(rubble_options INTERFACE -fsanitize=fuzzer-no-link)
endif()

# A fast linker, where one is installed: there are more than seventy programs to link.
find_program(RUBBLE_MOLD mold)
if(RUBBLE_MOLD AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND NOT CMAKE_CROSSCOMPILING)
  target_link_options(rubble_options INTERFACE -fuse-ld=mold)
endif()

# rubble_library_version(NAME VERSION) records a version for `rubble info` and the manifest.
function(rubble_library_version name version)
  set_property(GLOBAL APPEND PROPERTY RUBBLE_LIBRARY_VERSIONS "${name}=${version}")
endfunction()

# rubble_precompile(GROUP targets...) gives the targets one precompiled header, that of the first of
# them, with what most units include: it only saves time. Sanitizer builds and the fuzz targets do
# without it, so that a missing include is found. The targets of a group have the same flags, and a
# source with flags of its own is marked SKIP_PRECOMPILE_HEADERS.
option(RUBBLE_PRECOMPILE "Precompile the headers of the standard library" ON)
set(RUBBLE_COMMON_HEADERS
  <algorithm> <array> <cmath> <cstdint> <cstdio> <filesystem> <fstream> <functional> <map> <memory>
  <optional> <set> <sstream> <string> <string_view> <utility> <variant> <vector>)
function(rubble_precompile group)
  if(NOT RUBBLE_PRECOMPILE OR RUBBLE_SANITIZE OR RUBBLE_FUZZ)
    return()
  endif()
  foreach(target IN LISTS ARGN)
    get_property(first GLOBAL PROPERTY RUBBLE_PRECOMPILED_${group})
    if(first)
      target_precompile_headers(${target} REUSE_FROM ${first})
    else()
      set_property(GLOBAL PROPERTY RUBBLE_PRECOMPILED_${group} ${target})
      set(headers ${RUBBLE_COMMON_HEADERS})
      if(group STREQUAL "tests")
        list(APPEND headers <gtest/gtest.h>)
      elseif(group STREQUAL "benches")
        list(APPEND headers <CLI/CLI.hpp>)
      endif()
      target_precompile_headers(${target} PRIVATE ${headers})
    endif()
    # For compiler caches: they look at what is compiled, not at the file that was precompiled.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -fpch-preprocess)
    endif()
  endforeach()
endfunction()

# rubble_rooms(targets...) compiles the sources of each folder as one unit, so that a header is read
# once a room and not once a file. It only saves time; what it asks for is that no two files of a folder
# have helpers of the same name. Sources that CMake makes, or with flags of their own, stay apart, as do
# those that are marked SKIP_UNITY_BUILD_INCLUSION. A source with a UNITY_GROUP of its own keeps it: so a
# room of slow sources becomes two units. The preset dev and fuzz targets compile each file alone, so that
# a missing include is found.
option(RUBBLE_ROOMS "Compile the sources of a folder as one unit" ON)
function(rubble_rooms)
  if(NOT RUBBLE_ROOMS OR RUBBLE_FUZZ)
    return()
  endif()
  foreach(target IN LISTS ARGN)
    get_target_property(sources ${target} SOURCES)
    get_target_property(folder ${target} SOURCE_DIR)
    foreach(source IN LISTS sources)
      cmake_path(ABSOLUTE_PATH source BASE_DIRECTORY ${folder} OUTPUT_VARIABLE path)
      cmake_path(IS_PREFIX PROJECT_BINARY_DIR ${path} generated)
      if(generated)
        continue()
      endif()
      get_source_file_property(group ${path} TARGET_DIRECTORY ${target} UNITY_GROUP)
      if(group)
        continue()
      endif()
      cmake_path(GET path PARENT_PATH room)
      cmake_path(RELATIVE_PATH room BASE_DIRECTORY ${PROJECT_SOURCE_DIR} OUTPUT_VARIABLE room)
      string(REPLACE "/" "_" room "${room}")
      set_source_files_properties(${path} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${room})
    endforeach()
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
    # GCC takes a source that is included for a header, whose types others could see.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      set_target_properties(${target} PROPERTIES UNITY_BUILD_CODE_BEFORE_INCLUDE
        "#pragma GCC diagnostic ignored \"-Wsubobject-linkage\"")
    endif()
  endforeach()
endfunction()

# rubble_batches(targets...) compiles up to eight sources of a target as one unit, for programs whose sources include
# the same headers: most of what a test costs to compile is GoogleTest and the library that it tests. Helpers of a
# source stand in a namespace of its name. It only saves time, as rubble_rooms() does, and goes with it.
function(rubble_batches)
  if(NOT RUBBLE_ROOMS OR RUBBLE_FUZZ)
    return()
  endif()
  foreach(target IN LISTS ARGN)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE BATCH UNITY_BUILD_BATCH_SIZE 8)
  endforeach()
endfunction()

# rubble_load_first(TARGET LIBRARY...): programs that link TARGET name these shared libraries before all others. The
# dynamic linker looks every symbol up in one library after the other, in the order in which a program names them. Of
# the 200,000 that `rubble` begins with, 57,000 are OpenVDB's own and 12,000 OMPL's.
function(rubble_load_first target)
  if(NOT RUBBLE_SANITIZE)  # a sanitizer's own library has to be the first
    target_link_options(${target} INTERFACE ${ARGN})
  endif()
endfunction()
