// What is handed out, tried as on the machine of somebody else: Debian packages, an image for containers, a
// self-extracting archive. Takes minutes each. RUBBLE_ROOTS names a folder where the roots of bare systems
// are kept for the next time; without it they are made anew.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace package_test {

namespace fs = std::filesystem;

const std::string kTools = std::string(RUBBLE_SOURCE_DIR) + "/tools/package/";

bool has_program(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null 2>&1").c_str()) == 0;
}

// A folder for what is tried, and what was printed there last.
class Handed {
 public:
  // What the shell prints; `ok` says whether it ended well.
  std::string run(const std::string& command) {
    ok = std::system(("(" + command + ") >'" + scratch / "log" + "' 2>&1").c_str()) == 0;
    return read_file(scratch / "log");
  }
  std::string build() const { return fs::path(RUBBLE_PROGRAM).parent_path().string(); }
  // The package of that name, made by CPack.
  std::string make_package(const std::string& name) {
    const std::string printed =
        run("cpack --config '" + build() + "/CPackConfig.cmake' -B '" + scratch / "made" + "'");
    EXPECT_TRUE(ok) << printed;
    for (const auto& file : fs::directory_iterator(scratch / "made"))
      if (file.path().filename().string().rfind(name + "_", 0) == 0) return file.path().string();
    ADD_FAILURE() << "no package " << name << "\n" << printed;
    return "";
  }
  // A folder for the root of a system.
  std::string root_of(const std::string& suite) const {
    const char* kept = std::getenv("RUBBLE_ROOTS");
    return kept ? kept + ("/" + suite) : scratch / suite;
  }

  ScratchFolder scratch;
  bool ok = false;
  std::string log;  // of what was made first
};

// The same dataset as here: the pile's hash in both manifests.
const char* const kMission = "small.lua";

std::string state_hash_here(Handed& here) {
  const std::string folder = here.scratch / "here";
  const Outcome run = run_rubble("run scripts/" + std::string(kMission) + " --force --quiet --out " + folder);
  EXPECT_EQ(run.exit_code, 0) << run.err;
  return "state hash " + read_state_hash(folder);
}

// The commands of an example for CI servers, as written, on that machine with the package in the cache.
void try_ci_example(Handed& here, const std::string& example, const std::string& root, const std::string& package) {
  const std::string folder = root + "/tmp/ci";
  fs::remove_all(folder);
  for (const std::string& missions : {folder + "/missions", folder + "/robot/missions"}) {
    fs::create_directories(missions);
    write_file(missions + "/tiny.lua", kTinyMission);
    write_file(missions + "/suite.lua", "return suite { runs = { { name = \"one\", mission = \"tiny.lua\", "
                                        "golden = \"none\", expect = { frames = { 3, 3 } } } } }\n");
  }
  fs::create_directories(folder + "/package");
  fs::copy_file(package, fs::path(folder) / "package" / fs::path(package).filename());
  const std::string printed = here.run(
      "/usr/bin/python3 '" RUBBLE_SOURCE_DIR "/tests/app/ci_example.py' '" RUBBLE_SOURCE_DIR "/examples/ci/" + example +
      "' --script >'" + folder + "/script' && env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp CACHED=1 "
      "unshare --mount --pid --fork sh -c 'mount -t proc proc \"$0/proc\" && exec chroot \"$0\" sh -c "
      "\"cd /tmp/ci && sh -eu script\"' '" + root + "'");
  EXPECT_TRUE(here.ok) << example << "\n" << printed;
  EXPECT_NE(read_file(folder + "/report.xml").find("tests=\"1\" failures=\"0\""), std::string::npos)
      << example << "\n" << read_file(folder + "/report.xml");
  fs::remove_all(folder);
}

TEST(NightlyPackage, IsCleanAndMakesADatasetOnABareMachine) {
  Handed here;
  const std::string package = here.make_package("rubble");
  ASSERT_FALSE(package.empty());
  const std::string libraries = here.make_package("librubble-dev");
  ASSERT_FALSE(libraries.empty());
  if (!has_program("lintian")) GTEST_SKIP() << "lintian is not installed";
  EXPECT_EQ(here.run("lintian --allow-root --fail-on error,warning '" + package + "' '" + libraries + "'"), "");
  EXPECT_TRUE(here.ok);
  if (geteuid() != 0 || !has_program("debootstrap")) GTEST_SKIP() << "needs root and debootstrap";
  const std::string printed = here.run("'" + kTools + "test_package.sh' '" + package + "' '" + here.root_of("bookworm") + "' " + kMission);
  EXPECT_TRUE(here.ok) << printed;
  EXPECT_NE(printed.find("the dataset took"), std::string::npos) << printed;
  EXPECT_NE(printed.find(state_hash_here(here)), std::string::npos) << printed;
  for (const char* example : {"github-actions-package.yml", "gitlab-ci-package.yml"})
    try_ci_example(here, example, here.root_of("bookworm") + "/root", package);
}

TEST(NightlyImage, RunsInAContainerWithoutRootAndNetwork) {
  if (geteuid() != 0 || !has_program("debootstrap")) GTEST_SKIP() << "needs root and debootstrap";
  Handed here;
  const std::string package = here.make_package("rubble"), image = here.scratch / "image.tar";
  ASSERT_FALSE(package.empty());
  const std::string made = here.run("'" + kTools + "make_image.sh' '" + package + "' '" + here.root_of("image") + "' '" + image + "'");
  ASSERT_TRUE(here.ok) << made;
  const fs::path folder = here.scratch / "work";
  fs::create_directories(folder);
  fs::permissions(folder, fs::perms::all);
  if (!has_program("podman")) GTEST_SKIP() << "podman is not installed";
  // Its images in the folder of the test; what a cgroup manager would want is not needed.
  const std::string podman = "podman --root '" + here.scratch / "store" + "' --runroot '" + here.scratch / "run" +
                             "' --storage-driver vfs --cgroup-manager cgroupfs --events-backend file ";
  const std::string loaded = here.run(podman + "load -i '" + image + "'");
  ASSERT_TRUE(here.ok) << loaded;
  EXPECT_NE(loaded.find("rubble:0.1.0"), std::string::npos) << loaded;
  EXPECT_EQ(here.run(podman + "image inspect rubble:0.1.0 --format '{{.Config.User}} {{.Config.WorkingDir}} {{.Config.Cmd}}'"),
            "1000:1000 /work [rubble --help]\n");
  const std::string work = "cd /work && id -u && rubble run /usr/share/rubble/scripts/" + std::string(kMission) +
                           " --quiet --out out && rubble info out";
  std::string printed = here.run(podman + "run --rm --network none --cgroups disabled -v '" + folder.string() +
                                 ":/work' rubble:0.1.0 sh -c '" + work + "'");
  // Where the kernel lets no container begin (a sandbox), what Podman unpacked runs as it would there.
  if (printed.find("OCI permission denied") != std::string::npos) {
    const std::string mounted = here.run(podman + "image mount rubble:0.1.0 | tr -d '\\n'");
    printed = here.run("ROOT_USER=1000:1000 '" + kTools + "run_in_root.sh' '" + mounted + "' '" + work + "'");
    here.run("cp -r '" + mounted + "/work/out' '" + folder.string() + "'");
  }
  EXPECT_EQ(printed.substr(0, 5), "1000\n") << "not as root: " << printed;
  EXPECT_NE(printed.find(state_hash_here(here)), std::string::npos) << printed;
  EXPECT_TRUE(fs::exists(folder / "out/manifest.json"));
}

// One row a system: its suite, and the archive that it is made from.
class NightlyArchive : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  // The archive, made once for all systems.
  static void SetUpTestSuite() {
    made_ = new Handed;
    if (can_be_tried())
      made_->log = made_->run("'" + kTools + "make_archive.sh' '" + made_->build() + "' '" + made_->scratch / "made" + "'");
  }
  static void TearDownTestSuite() { delete made_; }
  static bool can_be_tried() { return geteuid() == 0 && has_program("debootstrap"); }
  static Handed* made_;
};
Handed* NightlyArchive::made_ = nullptr;

TEST_P(NightlyArchive, RunsOnAnotherDistribution) {
  if (!can_be_tried()) GTEST_SKIP() << "needs root and debootstrap";
  const auto [suite, mirror] = GetParam();
  Handed& here = *made_;
  here.run("ls '" + here.scratch / "made" + "'/rubble-*.run");
  ASSERT_TRUE(here.ok) << here.log;
  const std::string root = here.root_of(suite);
  const std::string bare = here.run("MIRROR=" + std::string(mirror) + " '" + kTools + "make_root.sh' '" + root + "' '' " + suite);
  ASSERT_TRUE(here.ok) << bare;
  fs::remove_all(root + "/tmp/try");
  fs::create_directories(root + "/tmp/try");
  fs::permissions(root + "/tmp/try", fs::perms::all);
  here.run("cp '" + here.scratch / "made" + "'/rubble-*.run '" + root + "/tmp/try/rubble.run'");
  const std::string printed = here.run(
      "'" + kTools + "run_in_root.sh' '" + root + "' 'cd /tmp/try && sh rubble.run -- /tmp/try/rubble && "
      "rubble/bin/rubble run rubble/share/rubble/scripts/" + kMission + " --quiet --out out && rubble/bin/rubble info out'");
  EXPECT_TRUE(here.ok) << printed;
  EXPECT_NE(printed.find("rubble 0.1.0 is in /tmp/try/rubble"), std::string::npos) << printed;
  EXPECT_NE(printed.find(state_hash_here(here)), std::string::npos) << printed;
  // The control: a second installation in the same place is refused.
  here.run("'" + kTools + "run_in_root.sh' '" + root + "' 'sh /tmp/try/rubble.run -- /tmp/try/rubble'");
  EXPECT_FALSE(here.ok);
  fs::remove_all(root + "/tmp/try");
}

INSTANTIATE_TEST_SUITE_P(Systems, NightlyArchive,
                         ::testing::Values(std::pair("trixie", "http://deb.debian.org/debian"),
                                           std::pair("noble", "http://archive.ubuntu.com/ubuntu")),
                         [](const auto& row) { return std::string(row.param.first); });

}  // namespace package_test
}  // namespace rubble::testing
