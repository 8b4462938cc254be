// The installed libraries, as a program of somebody else finds them: headers that are complete in
// themselves, and examples/cpp with the same results as in this tree.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "io/state/pile_state_file.h"
#include "kernel/base/hash.h"
#include "tests/app/program.h"

namespace rubble::testing {
namespace library_test {

namespace fs = std::filesystem;

// What the shell prints, and its exit code on a last line.
std::string shell(const ScratchFolder& scratch, const std::string& command) {
  std::system(("cd '" + scratch.path().string() + "' && (" + command + ") >out.txt 2>&1; echo exit $? >>out.txt").c_str());
  return read_file(scratch / "out.txt");
}

// Only what is meant for programs of others, in a folder that was moved since.
std::string install(const ScratchFolder& scratch) {
  const std::string build = fs::path(RUBBLE_PROGRAM).parent_path().string();
  const std::string printed = shell(scratch, "cmake --install '" + build + "' --component development --prefix here");
  fs::rename(scratch / "here", scratch / "there");
  return printed;
}

TEST(Library, PublicHeadersIncludeOnlyPublicOnes) {
  const ScratchFolder scratch;
  install(scratch);
  const fs::path root = scratch / "there/include/rubble";
  int count = 0;
  std::string all;
  for (const auto& file : fs::recursive_directory_iterator(root)) {
    if (!file.is_regular_file()) continue;
    all += "#include <rubble/" + fs::relative(file.path(), root).string() + ">\n";
    ++count;
  }
  EXPECT_GT(count, 30);
  const std::string compile = "g++ -std=c++17 -Wall -Wextra -fsyntax-only -I there/include all.cpp";
  write_file(scratch / "all.cpp", all);
  EXPECT_EQ(shell(scratch, compile), "exit 0\n");
  // The control: one that is missing is noticed.
  fs::remove(root / "kernel/model/track_builder.h");
  EXPECT_NE(shell(scratch, compile).find("kernel/model/track_builder.h"), std::string::npos);
}

// The kernel does without Embree; the program says in one error what is missing.
TEST(Library, WithoutEmbreeTheKernelAloneCanBeConfigured) {
  const ScratchFolder scratch;
  const std::string configure = "cmake -S '" RUBBLE_SOURCE_DIR "' -G Ninja -DCMAKE_DISABLE_FIND_PACKAGE_embree=ON ";
  const std::string kernel =
      shell(scratch, configure + "-B kernel -DRUBBLE_KERNEL_ONLY=ON && ninja -C kernel -t targets all");
  EXPECT_NE(kernel.find("librubble_kernel.a"), std::string::npos) << kernel;
  EXPECT_EQ(kernel.find("librubble_voids.a"), std::string::npos) << kernel;
  EXPECT_EQ(kernel.find("CMake Error"), std::string::npos) << kernel;
  const std::string program = shell(scratch, configure + "-B program");
  const std::size_t error = program.find("CMake Error");
  EXPECT_NE(program.find("libembree-dev"), std::string::npos) << program;
  EXPECT_EQ(program.find("CMake Error", error + 1), std::string::npos) << program;
}

TEST(Library, AConsumersProgramHasTheResultsOfThisTree) {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "a consumer without the sanitizer cannot link these libraries";
#endif
  const ScratchFolder scratch;
  ASSERT_NE(install(scratch).find("exit 0\n"), std::string::npos);
  const std::string built = shell(
      scratch, "cmake -S '" RUBBLE_SOURCE_DIR "/examples/cpp' -B build -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH=\"$PWD/there\""
               " && cmake --build build && mkdir theirs ours");
  ASSERT_NE(built.find("exit 0\n"), std::string::npos) << built;
  // settle_pile and find_voids of a build, in a folder.
  const auto run = [&](const std::string& settle, const std::string& find, const std::string& folder) {
    return shell(scratch, settle + " settle 7 " + folder + " && " + settle + " export " + folder + " && " + find + " " +
                              folder + "/pile.bin");
  };
  const std::string theirs = run("build/settle_pile", "build/find_voids", "theirs");
  ASSERT_NE(theirs.find("exit 0\n"), std::string::npos) << theirs;
  EXPECT_NE(theirs.find(", settled\n"), std::string::npos) << theirs;
  EXPECT_EQ(theirs, run("'" RUBBLE_EXAMPLES "/settle_pile'", "'" RUBBLE_EXAMPLES "/find_voids'", "ours"));
  for (const char* file : {"/pile.bin", "/pile.stl"})
    EXPECT_EQ(read_file(scratch / "theirs" + file), read_file(scratch / "ours" + file)) << file;
  const PileState pile = load_pile_state(scratch / "theirs/pile.bin");
  EXPECT_EQ(pile.pieces.size(), 80u);
  EXPECT_NE(theirs.find(hex64(pile.state_hash())), std::string::npos) << theirs;
  EXPECT_NE(shell(scratch, "build/settle_pile verify 7 ours").find("the same\nexit 0"), std::string::npos);
  const std::string stepped = shell(scratch, "build/step_world");
  EXPECT_NE(stepped.find("and rests\nfrom the snapshot on: the same bits\nexit 0"), std::string::npos) << stepped;
  EXPECT_EQ(stepped, shell(scratch, "'" RUBBLE_EXAMPLES "/step_world'"));
  // The control: another seed, another pile.
  EXPECT_NE(shell(scratch, "build/settle_pile verify 8 ours").find("not the same\nexit 5"), std::string::npos);
}

// What is asked of Rubble's folder within another build: its libraries and nothing else, by the prefix alone.
TEST(Library, IsAFolderOfAnotherBuild) {
  const ScratchFolder scratch;
  write_file(scratch / "CMakeLists.txt",
             "cmake_minimum_required(VERSION 3.25)\nproject(theirs LANGUAGES C CXX)\nadd_subdirectory(\"" RUBBLE_SOURCE_DIR
             "\" rubble)\nadd_executable(step_world \"" RUBBLE_SOURCE_DIR
             "/examples/cpp/step_world.cpp\")\ntarget_link_libraries(step_world PRIVATE Rubble::kernel)\n"
             "file(GENERATE OUTPUT seen.txt CONTENT \"$<TARGET_PROPERTY:Rubble::kernel,INTERFACE_INCLUDE_DIRECTORIES>\")\n");
  const std::string configured = shell(scratch, "cmake -S . -B out -G Ninja && ninja -C out -t targets all");
  ASSERT_NE(configured.find("exit 0\n"), std::string::npos) << configured;
  EXPECT_EQ(read_file(scratch / "out/seen.txt"), (scratch.path() / "out/rubble/include").string());
  EXPECT_NE(configured.find("step_world: phony"), std::string::npos) << configured;
  for (const char* other : {"kernel_tests", "librubble_render.a", "rubble_assets", "hash_probe"})
    EXPECT_EQ(configured.find(other), std::string::npos) << other;
  const std::string dry = shell(scratch, "ninja -C out -n step_world -v | grep step_world.cpp");
  EXPECT_NE(dry.find("-I"), std::string::npos) << dry;
  EXPECT_EQ(dry.find("-Wshadow"), std::string::npos) << dry;
  EXPECT_EQ(dry.find("-I" RUBBLE_SOURCE_DIR " "), std::string::npos) << dry;
}

TEST(Library, SaysWhatItCannotGive) {
  const ScratchFolder scratch;
  install(scratch);
  write_file(scratch / "CMakeLists.txt",
             "cmake_minimum_required(VERSION 3.25)\nproject(p LANGUAGES C CXX)\nfind_package(Rubble ${WANTED})\n");
  const auto configure = [&](const std::string& wanted) {
    return shell(scratch, "cmake -S . -B out -DCMAKE_PREFIX_PATH=\"$PWD/there\" -DWANTED='" + wanted + "'");
  };
  EXPECT_NE(configure("0.1;REQUIRED;COMPONENTS;kernel").find("exit 0\n"), std::string::npos);
  EXPECT_NE(configure("0.1;REQUIRED;COMPONENTS;renderer").find("no component renderer; expected kernel, robots, files or voids"), std::string::npos);
  EXPECT_NE(configure("0.2;REQUIRED").find("with requested version \"0.2\""), std::string::npos);
}

}  // namespace library_test
}  // namespace rubble::testing
