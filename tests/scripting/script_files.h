// A folder for a mission and the files that it reads.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "tests/scripting/test_support.h"

namespace rubble {

class ScriptFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::path(::testing::TempDir()) /
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  void write(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_ / name, std::ios::binary) << bytes;
  }
  // A mission of these keys.
  Mission load(const std::string& text) {
    return load_mission_text("return rubble.mission { " + text + " }", (folder_ / "m.lua").string());
  }

  std::filesystem::path folder_;
};

}  // namespace rubble
