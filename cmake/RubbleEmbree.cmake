# Embree 4 (Debian 13, Ubuntu 24.04) or 3 (Debian 12) as the target rubble_embree; no target where neither is there.
# kernel/base/system/embree.h is what differs. Found here, at the top, so that every folder sees it.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
  find_package(embree 3 QUIET)
endif()
if(embree_FOUND)
  string(REGEX MATCH "^[0-9]+" embree_major ${embree_VERSION})
  add_library(rubble_embree INTERFACE)
  target_link_libraries(rubble_embree INTERFACE embree)
  target_compile_definitions(rubble_embree INTERFACE RUBBLE_EMBREE=${embree_major})
endif()
