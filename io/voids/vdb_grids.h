// OpenVDB's grids as its library has compiled them: without these declarations each unit that makes
// a grid would compile the whole tree of its values again (vdb_file.cpp: 43 s instead of 9). The library
// does not offer what is inline in its headers: builds that inline less, as those of the sanitizers do, are
// without RUBBLE_GRIDS_OF_LIBRARY and compile the trees.
#pragma once

#include <openvdb/openvdb.h>

#ifdef RUBBLE_GRIDS_OF_LIBRARY
namespace openvdb {
OPENVDB_USE_VERSION_NAMESPACE
namespace OPENVDB_VERSION_NAME {

#define RUBBLE_VDB_TREE(Value)                                                                    \
  extern template class tree::LeafNode<Value, 3>;                                                 \
  extern template class tree::InternalNode<tree::LeafNode<Value, 3>, 4>;                          \
  extern template class tree::InternalNode<tree::InternalNode<tree::LeafNode<Value, 3>, 4>, 5>;   \
  extern template class tree::RootNode<                                                           \
      tree::InternalNode<tree::InternalNode<tree::LeafNode<Value, 3>, 4>, 5>>;                    \
  extern template class tree::Tree<tree::RootNode<                                                \
      tree::InternalNode<tree::InternalNode<tree::LeafNode<Value, 3>, 4>, 5>>>;                   \
  extern template class Grid<tree::Tree<tree::RootNode<                                           \
      tree::InternalNode<tree::InternalNode<tree::LeafNode<Value, 3>, 4>, 5>>>>;

RUBBLE_VDB_TREE(float)
RUBBLE_VDB_TREE(bool)
RUBBLE_VDB_TREE(Int32)
#undef RUBBLE_VDB_TREE

}  // namespace OPENVDB_VERSION_NAME
}  // namespace openvdb
#endif
