// A folder for mesh files, and what their reader says of them.
#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "io/base/atomic_file.h"
#include "io/mesh/mesh_file.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble::test {

class MeshFiles : public ::testing::Test {
 protected:
  TriangleMesh load(const std::string& file, const std::string& bytes, const MeshUnits& units = {}) {
    write_text_file(folder_ / file, bytes);
    return importer_.load_mesh(folder_ / file, units);
  }
  template <class Action>
  static std::string mistake_of(const Action& action) {
    try {
      action();
    } catch (const InputError& error) {
      return error.diagnostics().front().text();
    }
    return "no error";
  }
  std::string error_of(const std::string& file, const std::string& bytes) {
    return mistake_of([&] { load(file, bytes); });
  }
  std::string notes() const {
    std::string all;
    for (const std::vector<std::string>* list : {&importer_.notes().shape, &importer_.notes().looks})
      for (const std::string& note : *list) all += note + "\n";
    return all;
  }

  ScratchFolder folder_;
  MeshImporter importer_;
};

}  // namespace rubble::test
