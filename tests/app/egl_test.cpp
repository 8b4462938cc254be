// Every way in which a machine can lack a working EGL gives a message that says what was tried and
// what to do. Most are played by a libEGL of ours, which breaks where it is told to.
#include <gtest/gtest.h>

#include <optional>
#include <vector>

#include "app/mission/resolved_mission.h"
#include "app/support/drawing_device.h"
#include "tests/app/program.h"
#include "tests/base/environment.h"

namespace rubble::testing {
namespace egl_test {

// Whether a text holds all of these.
::testing::AssertionResult holds(const std::string& text, const std::vector<const char*>& parts) {
  for (const char* part : parts)
    if (text.find(part) == std::string::npos)
      return ::testing::AssertionFailure() << "no \"" << part << "\" in\n" << text;
  return ::testing::AssertionSuccess();
}

Outcome with_fake_egl(const std::string& stage, const std::string& arguments = "info --gl") {
  return run_rubble(arguments, "RUBBLE_EGL_LIBRARY='" RUBBLE_FAKE_EGL "' FAKE_EGL=" + stage);
}

struct Breakage {
  const char* stage;
  std::vector<const char*> says;
};

class BrokenEgl : public ::testing::TestWithParam<Breakage> {};

TEST_P(BrokenEgl, IsNamedWithWhatWasTriedAndWhatToDo) {
  const Outcome info = with_fake_egl(GetParam().stage);
  EXPECT_EQ(info.exit_code, 2);
  EXPECT_TRUE(holds(info.err, GetParam().says));
  EXPECT_TRUE(holds(info.err, {"cannot draw", "Tried:", "surfaceless platform", "default display",
                               "libgl1-mesa-dri", "RUBBLE_DEVICE=gl:N", "rubble info --gl"}));
}

INSTANTIATE_TEST_SUITE_P(
    Stages, BrokenEgl,
    ::testing::Values(
        Breakage{"no_devices", {"default display: no display: EGL_NOT_INITIALIZED"}},
        Breakage{"no_display", {"EGL device 0 (hardware): no display"}},
        Breakage{"no_initialize", {"cannot initialize: EGL_NOT_INITIALIZED"}},
        Breakage{"no_surfaceless", {"no EGL_KHR_surfaceless_context"}},
        Breakage{"no_desktop_gl", {"no desktop OpenGL"}},
        Breakage{"no_context", {"no OpenGL 4.5 core context"}},
        Breakage{"no_current", {"cannot make the context current"}},
        Breakage{"no_function", {"the driver has no glClipControl"}},
        Breakage{"old_gl", {"OpenGL 4.5 is needed, the driver gives \"3.3 fake\""}},
        Breakage{"no_extension", {"the driver has no GL_ARB_indirect_parameters, which OpenGL has from 4.6 on"}},
        Breakage{"small", {"texture size: at least 4096 are needed, the driver has 1024"}}),
    [](const auto& stage) { return std::string(stage.param.stage); });

// The control: the fake works where nothing is to break.
TEST(FakeEgl, WorksUnlessItIsToBreak) {
  const Outcome info = with_fake_egl("nowhere", "info --gl");
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_TRUE(holds(info.out, {"EGL device 0 (hardware): fake, OpenGL 4.5 fake", "chosen",
                               "the first that works", "texture size"}));
}

TEST(InfoGl, ShowsEveryWayEvenWhereNoneWorks) {
  const Outcome info = with_fake_egl("no_context", "info --gl");
  EXPECT_EQ(info.exit_code, 2);
  EXPECT_TRUE(holds(info.out, {"ways to draw", "EGL device 0 (hardware): no OpenGL 4.5 core context",
                               "surfaceless platform", "RUBBLE_DEVICE: not set"}));
}

TEST(InfoGl, SaysWhyADeviceWasChosen) {
  const Outcome option = run_rubble("info --device gl:0", "RUBBLE_DEVICE=gl:7");
  EXPECT_EQ(option.exit_code, 0) << option.err;
  EXPECT_TRUE(holds(option.out, {"asked for by its number", "RUBBLE_DEVICE: gl:7", "texture units"}));
  const Outcome environment = run_rubble("info --gl", "RUBBLE_DEVICE=gl:0");
  EXPECT_TRUE(holds(environment.out, {"asked for by its number"}));
}

TEST(MissingEgl, ALibraryThatDoesNotLoadIsNamed) {
  const ScratchFolder folder;
  write_file(folder / "libEGL.so.1", "no library at all");
  const Outcome info = run_rubble("info --gl", "RUBBLE_EGL_LIBRARY='" + (folder / "libEGL.so.1") + "'");
  EXPECT_EQ(info.exit_code, 2);
  EXPECT_TRUE(holds(info.err, {"libEGL.so.1 does not load", "libegl1"}));
  const Outcome other = run_rubble("info --gl", "RUBBLE_EGL_LIBRARY=libm.so.6");
  EXPECT_TRUE(holds(other.err, {"the EGL library has no eglGetProcAddress"}));
}

TEST(MissingEgl, AVariableThatHidesTheDriversIsNamed) {
  const Outcome files = run_rubble("info --gl", "__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere/50_none.json");
  EXPECT_EQ(files.exit_code, 2);
  EXPECT_TRUE(holds(files.err, {"__EGL_VENDOR_LIBRARY_FILENAMES=/nowhere/50_none.json is set",
                                "there is no /nowhere/50_none.json", "try without it"}));
  const ScratchFolder empty;
  const Outcome folder =
      run_rubble("info --gl", "__EGL_VENDOR_LIBRARY_DIRS='" + empty.path().string() + "'");
  EXPECT_EQ(folder.exit_code, 2);
  EXPECT_TRUE(holds(folder.err, {"__EGL_VENDOR_LIBRARY_DIRS=", "drivers are looked for only there"}));
}

TEST(MissingEgl, AContainersDriverThatCannotDrawIsNamed) {
  const Outcome without = run_rubble("info --gl", "NVIDIA_DRIVER_CAPABILITIES=compute,utility");
  EXPECT_TRUE(holds(without.out, {"NVIDIA_DRIVER_CAPABILITIES=compute,utility is set", "add `graphics`"}));
  for (const char* with : {"compute,graphics", "all"}) {
    const Outcome info = run_rubble("info --gl", std::string("NVIDIA_DRIVER_CAPABILITIES=") + with);
    EXPECT_EQ(info.out.find("NVIDIA_DRIVER_CAPABILITIES"), std::string::npos) << info.out;
  }
}

TEST(MissingEgl, ADriverTooOldIsNamed) {
  const Outcome info = run_rubble("info --gl", "MESA_GL_VERSION_OVERRIDE=3.3");
  EXPECT_EQ(info.exit_code, 2);
  EXPECT_TRUE(holds(info.err, {"no OpenGL 4.5 core context", "MESA_GL_VERSION_OVERRIDE=3.3 is set"}));
}

TEST(MissingEgl, ARunSaysSoBeforeItHasDrawnAnything) {
  const ScratchFolder folder;
  write_file(folder / "tiny.lua", kTinyMission);
  const Outcome run = run_rubble("run '" + (folder / "tiny.lua") + "' --quiet --out '" +
                                     (folder / "out") + "' --device gl:42",
                                 "");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(holds(run.err, {"there is no EGL device 42", "EGL lists", "the device gl draws because --device"}));
}

// The software device opens no library of graphics: this one is nowhere.
const char* const kNoEgl = "RUBBLE_EGL_LIBRARY=/nowhere/libEGL.so.1";

TEST(SoftwareDevice, DrawsWhereThereIsNoEgl) {
  const ScratchFolder folder;
  write_file(folder / "tiny.lua", kTinyMission);
  const std::string run = "run '" + (folder / "tiny.lua") + "' --quiet --out '";
  const Outcome plain = run_rubble(run + (folder / "plain") + "'", kNoEgl);
  EXPECT_EQ(plain.exit_code, 0) << plain.err;
  EXPECT_TRUE(holds(read_file(folder / "plain/manifest.json"), {"\"device\": \"software\""}));
  const Outcome info = run_rubble("info", kNoEgl);
  EXPECT_EQ(info.exit_code, 0) << info.err;
  EXPECT_TRUE(holds(info.out, {"software: the processor, by"}));
  // The control: what asks for a card says what is missing.
  const Outcome card = run_rubble(run + (folder / "card") + "'", std::string(kNoEgl) + " RUBBLE_DEVICE=gl");
  EXPECT_EQ(card.exit_code, 2);
  EXPECT_TRUE(holds(card.err, {"/nowhere/libEGL.so.1 does not load"}));
}

// What a card drew is drawn by one again, whatever the variable says now.
TEST(GlDevice, IsInTheManifestAndDrawsAgain) {
  const ScratchFolder folder;
  write_file(folder / "tiny.lua", kTinyMission);
  const Outcome run = run_rubble("run '" + (folder / "tiny.lua") + "' --quiet --device gl --out '" + (folder / "out") + "'",
                                 "RUBBLE_DEVICE=software");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(holds(read_file(folder / "out/manifest.json"), {"\"device=gl\"", "\"device\": \"gl\"", "\"gl_renderer\""}));
  const std::string verify = "verify '" + (folder / "out") + "' --quiet";
  const Outcome verified = run_rubble(verify, "RUBBLE_DEVICE=software");
  EXPECT_EQ(verified.exit_code, 0) << verified.out << verified.err;
  const Outcome without = run_rubble(verify, kNoEgl);
  EXPECT_EQ(without.exit_code, 2) << "the control";
  EXPECT_TRUE(holds(without.err, {"/nowhere/libEGL.so.1 does not load", "the manifest of the run says so"}));
  const Outcome other = run_rubble(verify + " --device software");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_TRUE(holds(other.err, {"--device", "is not the device that drew this run", "leave it out"}));
}

// Nothing but the mission is read: what would draw it is in the scenario that it resolves to.
TEST(Devices, OptionOverVariableOverMission) {
  const ScratchFolder folder;
  std::string mission = kTinyMission;
  mission.insert(mission.find('{') + 1, " device = \"gl\",");
  write_file(folder / "by_gl.lua", mission);
  const auto resolved = [&](const std::optional<std::string>& variable, const std::string& option,
                            const std::vector<std::string>& set = {}) {
    const Environment device("RUBBLE_DEVICE", variable);
    RunRequest request;
    request.mission = folder / "by_gl.lua", request.overrides = set;
    request.options.quiet = true, request.options.device = option;
    RunContext context(request.options);
    return resolve_mission(request, RunKind::run, context).scenario.device;
  };
  EXPECT_EQ(resolved({}, ""), DeviceKind::gl);
  EXPECT_EQ(resolved("", ""), DeviceKind::gl);
  EXPECT_EQ(resolved("software", ""), DeviceKind::software);
  EXPECT_EQ(resolved("software", "gl:1"), DeviceKind::gl);
  EXPECT_EQ(resolved("gl", "software"), DeviceKind::software);
  EXPECT_EQ(resolved("gl", "", {"device=software"}), DeviceKind::software);
  const auto card = [](const std::string& variable, const std::string& option) {
    const Environment device("RUBBLE_DEVICE", variable);
    return asked_device(option)->card;
  };
  EXPECT_EQ(card("gl:3", ""), 3);
  EXPECT_EQ(card("gl:3", "gl"), -1);
  EXPECT_EQ(card("gl", "gl:2"), 2);
}

TEST(Devices, AreNamedWhereOneIsUnknown) {
  const ScratchFolder folder;
  write_file(folder / "tiny.lua", kTinyMission);
  const std::string run = "run '" + (folder / "tiny.lua") + "' --quiet --out '" + (folder / "out") + "'";
  for (const char* wrong : {"vulkan", "gl:", "gl:first", "gl:-1", "GL", "gl:0x1"}) {
    EXPECT_FALSE(read_device(wrong)) << wrong;
    const Outcome variable = run_rubble(run, std::string("RUBBLE_DEVICE=") + wrong);
    EXPECT_EQ(variable.exit_code, 1) << wrong;
    EXPECT_TRUE(holds(variable.err, {"RUBBLE_DEVICE", "software, gl, or gl:N", wrong}));
  }
  const Outcome option = run_rubble(run + " --device vulkan");
  EXPECT_EQ(option.exit_code, 1);
  EXPECT_TRUE(holds(option.err, {"--device", "software, gl, or gl:N", "vulkan"}));
  const Outcome key = run_rubble(run + " --set device=vulkan");
  EXPECT_EQ(key.exit_code, 1);
  EXPECT_TRUE(holds(key.err, {"device", "software", "gl", "vulkan"}));
  const Outcome both = run_rubble(run + " --device gl --set device=software");
  EXPECT_EQ(both.exit_code, 1);
  EXPECT_TRUE(holds(both.err, {"--device", "is given beside --set device=software", "one of them"}));
  for (const char* command : {"run", "settle", "check"}) {
    const Outcome seeds = run_rubble(std::string(command) + " '" + (folder / "tiny.lua") + "' --seed 1 --set seed=7");
    EXPECT_EQ(seeds.exit_code, 1) << command;
    EXPECT_TRUE(holds(seeds.err, {"--seed", "is given beside --set seed=7", "one of them"})) << command;
  }
}

// A millionth of a second is too short for any light.
TEST(EvenFrames, AreNamedOnceInTheLogAndTheManifest) {
  const ScratchFolder folder;
  write_file(folder / "tiny.lua", kTinyMission);
  const Outcome run =
      run_rubble("run '" + (folder / "tiny.lua") + "' --quiet --out '" + (folder / "out") +
                 "' --set camera.exposure.mode=fixed --set camera.exposure.time=1e-6"
                 " --set camera.exposure.iso=1 --set camera.sensor.noise=false --set light.cone_deg=20");
  EXPECT_EQ(run.exit_code, 0) << run.err;
  EXPECT_TRUE(holds(run.err, {"warning: frame 0 is all one colour"}));
  EXPECT_EQ(run.err.find("frame 1 is all"), std::string::npos);
  EXPECT_TRUE(holds(read_file(folder / "out/manifest.json"), {"\"warnings\": [", "light.cone_deg: has no effect", "frame 0 is all"}));
  const Outcome good = run_rubble("run '" + (folder / "tiny.lua") + "' --quiet --out '" +
                                  (folder / "good") + "'");
  EXPECT_EQ(good.err.find("warning"), std::string::npos) << good.err;
}

// Sanitizers reserve more addresses than any limit leaves.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(OutOfMemory, IsAnErrorAndNoBlackFrame) {
  const ScratchFolder folder;
  write_file(folder / "tiny.lua", kTinyMission);
  const Outcome run = run_rubble("run '" + (folder / "tiny.lua") + "' --quiet --out '" +
                                     (folder / "out") +
                                     "' --set camera.width=8192 --set camera.height=8192",
                                 "ulimit -v 1500000 &&");
  EXPECT_EQ(run.exit_code, 2);
  EXPECT_TRUE(holds(run.err, {"out of memory"}));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out" / "manifest.json"));
}
#endif

}  // namespace egl_test
}  // namespace rubble::testing
