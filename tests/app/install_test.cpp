// What `cmake --install` leaves: found from where it lies, complete, and true to the program.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>

#include "tests/app/program.h"

namespace rubble::testing {
namespace install_test {

namespace fs = std::filesystem;

// Installed once for all tests of the suite, then moved.
class Install : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new ScratchFolder;
    const std::string build = fs::path(RUBBLE_PROGRAM).parent_path().string();
    const std::string command = "cmake --install '" + build + "' --prefix '" + *scratch_ / "here" +
                                "' >'" + *scratch_ / "log" + "' 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << read_file(*scratch_ / "log");
    fs::rename(*scratch_ / "here", *scratch_ / "there");
  }
  static void TearDownTestSuite() { delete scratch_; }

  static fs::path at(const std::string& name) { return fs::path(*scratch_ / "there") / name; }

  // What the shell prints, and its exit code on a last line.
  static std::string run(const std::string& command) {
    const std::string all = "cd '" + *scratch_ / "" + "' && unset RUBBLE_ASSETS && export PATH='" +
                            at("bin").string() + "':$PATH && (" + command + ") >'" +
                            *scratch_ / "out" + "' 2>&1; echo exit $? >>'" + *scratch_ / "out" + "'";
    std::system(all.c_str());
    return read_file(*scratch_ / "out");
  }

  static ScratchFolder* scratch_;
};
ScratchFolder* Install::scratch_ = nullptr;

TEST_F(Install, TheProgramFindsItsAssetsWhereverItLies) {
  write_file(*scratch_ / "tiny.lua", kTinyMission);
  const std::string settled = run("rubble settle tiny.lua --out pile && rubble info pile");
  EXPECT_NE(settled.find("exit 0"), std::string::npos) << settled;
  // The control: it does not use those of the build.
  fs::rename(at("share/rubble/assets"), at("share/rubble/elsewhere"));
  const std::string lost = run("rubble settle tiny.lua --out none");
  EXPECT_NE(lost.find("exit 1"), std::string::npos) << lost;
  EXPECT_NE(lost.find("set RUBBLE_ASSETS to their folder"), std::string::npos) << lost;
  const std::string told = run("RUBBLE_ASSETS='" + at("share/rubble/elsewhere").string() +
                               "' rubble settle tiny.lua --out told && cmp pile/pile.bin told/pile.bin");
  EXPECT_NE(told.find("exit 0"), std::string::npos) << told;
  fs::rename(at("share/rubble/elsewhere"), at("share/rubble/assets"));
}

TEST_F(Install, EveryCommandHasAManualPageThatManReads) {
  const std::string help = run_rubble("--help").out;
  EXPECT_NE(help.find("RUBBLE_ASSETS"), std::string::npos);
  for (const char* name : {"rubble", "rubble-run", "rubble-eval-map", "rubble-assets-show", "rubble-batch"}) {
    const fs::path page = at("share/man/man1/" + std::string(name) + ".1.gz");
    ASSERT_TRUE(fs::exists(page)) << page;
    const std::string text = run("LC_ALL=C MANWIDTH=80 man --warnings -l '" + page.string() + "' | cat");
    EXPECT_NE(text.find("SYNOPSIS"), std::string::npos) << text;
    EXPECT_EQ(text.find("warning"), std::string::npos) << text;
  }
  const std::string batch = run("MANWIDTH=200 man -l '" + at("share/man/man1/rubble-batch.1.gz").string() + "' | cat");
  for (const char* words : {"--shard I/N", "--set KEY=VALUE", "EXIT STATUS", "did not settle"})
    EXPECT_NE(batch.find(words), std::string::npos) << words << " in\n" << batch;
}

// What bash offers for a line.
std::string completions(const fs::path& script, const std::string& words, int at) {
  return "bash --norc -c '. \"" + script.string() + "\"; compopt() { :; }; COMP_WORDS=(" + words +
         "); COMP_CWORD=" + std::to_string(at) + "; _rubble; echo \"${COMPREPLY[@]}\"'";
}

TEST_F(Install, BashCompletesCommandsOptionsAndKeys) {
  const fs::path script = at("share/bash-completion/completions/rubble");
  EXPECT_EQ(run(completions(script, "rubble set", 1)).substr(0, 7), "settle\n");
  EXPECT_EQ(run(completions(script, "rubble eval tr", 2)).substr(0, 11), "trajectory\n");
  EXPECT_EQ(run(completions(script, "rubble eval map --vox", 3)).substr(0, 8), "--voxel\n");
  EXPECT_EQ(run(completions(script, "rubble run m.lua --che", 3)).substr(0, 19), "--checkpoint-every\n");
  EXPECT_EQ(run(completions(script, "rubble run m.lua --set pile.lay", 4)).substr(0, 13), "pile.layers=\n");
  const std::string syntax = run("command -v zsh >/dev/null || exit 0; zsh -n '" +
                                 at("share/zsh/vendor-completions/_rubble").string() + "'");
  EXPECT_EQ(syntax, "exit 0\n");
}

TEST_F(Install, HasWhatAnEditorAndAReaderNeed) {
  for (const char* name : {"share/rubble/editor/rubble.lua", "share/rubble/scripts/first_pile.lua",
                           "share/rubble/assets/concrete/pack.lua", "share/doc/rubble/docs/reference/missions.md",
                           "share/doc/rubble/copyright"})
    EXPECT_TRUE(fs::exists(at(name))) << name;
  EXPECT_EQ(read_file(at("share/rubble/editor/rubble.lua")), run_rubble("check --annotations").out);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // their reports name sources
  for (const auto& file : fs::recursive_directory_iterator(at(""))) {
    if (!file.is_regular_file() || file.path().extension() == ".obj") continue;
    EXPECT_EQ(read_file(file.path()).find(RUBBLE_SOURCE_DIR "/app"), std::string::npos)
        << file.path() << " holds a path of the build";
  }
#endif
}

// What a package for another processor depends on; packages as Debian makes them, and a program of this machine.
TEST(LibraryDepends, AreWhatShlibsFilesSay) {
  const ScratchFolder scratch;
  const auto make_package = [&](const std::string& name, const std::string& shlibs) {
    fs::create_directories(scratch / (name + "/DEBIAN"));
    write_file(scratch / (name + "/DEBIAN/control"), "Package: " + name + "\nVersion: 1\nArchitecture: all\n"
                                                     "Maintainer: Nobody <nobody@example.org>\nDescription: none\n");
    if (!shlibs.empty()) write_file(scratch / (name + "/DEBIAN/shlibs"), shlibs);
    return std::system(("dpkg-deb -b '" + (scratch / name) + "' '" + (scratch / (name + ".deb")) + "' >/dev/null").c_str());
  };
  ASSERT_EQ(make_package("libc6", "libc 6 libc6 (>= 2.36)\nlibm 6 libc6 (>= 2.36)\nudeb: libc 6 libc6-udeb\n"), 0);
  ASSERT_EQ(make_package("libother1", "libother 1 libother1\n"), 0);
  ASSERT_EQ(make_package("data", ""), 0);
  const auto ask = [&](const std::string& packages) {
    const std::string command = "cd '" + scratch.path().string() + "' && '" RUBBLE_SOURCE_DIR
                                "/tools/package/library_depends.py' /bin/true " + packages + " >out 2>&1";
    const int status = std::system(command.c_str());
    return read_file(scratch / "out") + (status == 0 ? "" : "failed");
  };
  EXPECT_EQ(ask("data.deb libother1.deb libc6.deb"), "libc6 (>= 2.36)\n");
  EXPECT_EQ(ask("data.deb libother1.deb"), "no package says who has libc.so.6\nfailed");
}

// An archive of a program that only tells its version.
class SelfExtractingArchive : public ::testing::Test {
 protected:
  SelfExtractingArchive() {
    fs::create_directories(scratch_ / "stage/bin");
    fs::create_directories(scratch_ / "stage/libexec");
    fs::create_directories(scratch_ / "home");
    write_file(scratch_ / "stage/bin/rubble", "#!/bin/sh\necho rubble 1.2.3\n");
    fs::permissions(scratch_ / "stage/bin/rubble", fs::perms::owner_all);
    write_file(scratch_ / "stage/libexec/rubble", "");
    EXPECT_EQ(run("'" RUBBLE_SOURCE_DIR "/tools/package/self_extracting.sh' stage 1.2.3 rubble.run"), "exit 0\n");
  }
  // What the shell prints there, and its exit code on a last line.
  std::string run(const std::string& command) {
    const std::string out = scratch_ / "out";
    std::system(("cd '" + scratch_.path().string() + "' && export HOME=\"$PWD/home\" && (" + command + ") >'" + out +
                 "' 2>&1; echo exit $? >>'" + out + "'").c_str());
    return read_file(out);
  }
  static bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

  const ScratchFolder scratch_;
};

TEST_F(SelfExtractingArchive, HasTheHelpOfRubble) {
  const std::string help = run("sh rubble.run --help");
  EXPECT_EQ(help.substr(0, 23), "Installs Rubble 1.2.3, ") << help;
  EXPECT_TRUE(has(help, "usage: sh rubble.run [FOLDER]") && has(help, "exit 0")) << help;
  EXPECT_TRUE(has(run("sh rubble.run --list"), "./libexec/rubble\n"));
  const std::string unknown = run("sh rubble.run --target x");
  EXPECT_TRUE(has(unknown, "expected FOLDER, --list or --help, found: --target") && has(unknown, "exit 2")) << unknown;
}

TEST_F(SelfExtractingArchive, InstallsBesideWhatIsThere) {
  // A checkout of that name, say.
  fs::create_directories(scratch_ / "home/rubble");
  write_file(scratch_ / "home/rubble/mine", "mine");
  EXPECT_TRUE(has(run("sh rubble.run"), "rubble 1.2.3 is in " + (scratch_ / "home/rubble-1.2.3")));
  EXPECT_TRUE(has(run("sh rubble.run home/rubble"), "is in home/rubble/rubble-1.2.3"));
  EXPECT_EQ(read_file(scratch_ / "home/rubble/mine"), "mine");
  EXPECT_TRUE(has(run("sh rubble.run -- new/folder && new/folder/bin/rubble"), "rubble 1.2.3\nexit 0"));
  // One that is there is neither replaced nor nested.
  const std::string again = run("sh rubble.run new/folder");
  EXPECT_TRUE(has(again, "Rubble is in new/folder already") && has(again, "exit 1")) << again;
}

TEST_F(SelfExtractingArchive, LeavesNothingWhereItIsDamaged) {
  const std::string printed = run("head -c $(($(wc -c <rubble.run) - 9)) rubble.run >cut.run; sh cut.run new");
  EXPECT_TRUE(has(printed, "the archive is damaged or cut off") && has(printed, "exit 1")) << printed;
  EXPECT_FALSE(fs::exists(scratch_ / "new") || fs::exists(scratch_ / "new.part"));
}

// Lists of packages for several releases. Asks for none that would be installed.
TEST(PackageLists, TakeWhatTheReleaseHas) {
  ScratchFolder scratch;
  const auto install = [&](const std::string& list) {
    write_file(scratch / "list", list);
    const int status = std::system(("PATH='" + scratch.path().string() + ":/usr/sbin:/usr/bin:/sbin:/bin' '" RUBBLE_SOURCE_DIR
                                    "/tools/install_packages.sh' '" + (scratch / "list") + "' >'" + (scratch / "out") + "' 2>&1").c_str());
    return read_file(scratch / "out") + "exit " + std::to_string(WEXITSTATUS(status));
  };
  // apt-get as a program that only says what it was asked for.
  write_file(scratch / "apt-get", "#!/bin/sh\necho apt-get $*\n");
  write_file(scratch / "sudo", "#!/bin/sh\nexec \"$@\"\n");
  write_file(scratch / "apt-cache", "#!/bin/sh\ncase $2 in has-*) echo '  Candidate: 1' ;; *) echo '  Candidate: (none)' ;; esac\n");
  for (const char* name : {"apt-get", "sudo", "apt-cache"}) fs::permissions(scratch / name, fs::perms::owner_all);

  EXPECT_EQ(install("# a comment\n\nno-such|dpkg\nno-such if-missing sh\nno-such if-available\n"), "exit 0");
  EXPECT_EQ(install("no-such|has-it|has-more\nhas-another if-available\n"),
            "apt-get update -q\nInstalling with apt: has-it has-another\n"
            "apt-get install -q -y --no-install-recommends has-it has-another\nexit 0");
  const std::string lacking = install("no-such|no-other\n");
  EXPECT_NE(lacking.find("This release has no package of these names: no-such|no-other\n"), std::string::npos) << lacking;
  EXPECT_NE(lacking.find("exit 2"), std::string::npos) << lacking;
  const std::string slip = install("dpkg if-avaliable\n");
  EXPECT_NE(slip.find("expected NAME, if-missing COMMAND or if-available, found: dpkg if-avaliable"), std::string::npos) << slip;
}

TEST(Manual, SaysWhatIsNotThere) {
  const Outcome unknown = run_rubble("manual nix");
  EXPECT_EQ(unknown.exit_code, 1);
  EXPECT_NE(unknown.err.find("no such command"), std::string::npos) << unknown.err;
  EXPECT_EQ(run_rubble("manual eval map").out.substr(0, 19), ".TH RUBBLE\\-EVAL\\-M");
  EXPECT_EQ(run_rubble("manual --all /proc/none").exit_code, 2);
  const Outcome shell = run_rubble("completion fish");
  EXPECT_EQ(shell.exit_code, 1);
  EXPECT_NE(shell.err.find("expected bash or zsh, found `fish`"), std::string::npos) << shell.err;
}

}  // namespace install_test
}  // namespace rubble::testing
