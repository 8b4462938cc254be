// What a third-party importer does to a child process must be an error message here.
#include "kernel/base/system/isolated_worker.h"

#include <fcntl.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <vector>

#include "io/base/atomic_file.h"
#include "io/image/exr_file.h"
#include "kernel/base/error.h"
#include "tests/io/support.h"

namespace rubble {
namespace isolated_worker_test {

using test::ScratchFolder;

std::string error_of(const std::function<std::string()>& work, const ImportLimits& limits = {}) {
  try {
    return "no error, but " + run_isolated("a.obj", "mesh", work, limits);
  } catch (const InputError& error) {
    return error.what();
  }
}

bool contains(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(IsolatedWorker, GivesWhatTheWorkGives) {
  const std::string big(5 << 20, 'x');  // more than a pipe holds
  EXPECT_EQ(run_isolated("a", "mesh", [&] { return big + "end"; }), big + "end");
  EXPECT_EQ(run_isolated("a", "mesh", [] { return std::string(); }), "");
}

TEST(IsolatedWorker, PassesOnEveryFieldOfAnError) {
  try {
    run_isolated("a", "mesh", []() -> std::string {
      throw InputError({{"f", 3, "k", "m", "e", "o", "h"}, {"g", 0, "", "second", "", "", ""}});
    });
    FAIL() << "no error";
  } catch (const InputError& error) {
    ASSERT_EQ(error.diagnostics().size(), 2u);
    EXPECT_EQ(error.diagnostics()[0].text(), "f:3: k: m: expected e, found o (h)");
    EXPECT_EQ(error.diagnostics()[1].message, "second");
  }
}

TEST(IsolatedWorker, ACrashIsAnError) {
  const auto killed = [](int signal) {
    return error_of([signal] {
      std::signal(signal, SIG_DFL);  // a sanitizer would report it first
      std::raise(signal);
      return std::string();
    });
  };
  for (const int signal : {SIGSEGV, SIGABRT, SIGBUS, SIGILL, SIGFPE}) {
    EXPECT_TRUE(contains(killed(signal), "a.obj: cannot be read as a mesh: the importer crashed"))
        << killed(signal);
  }
  EXPECT_TRUE(contains(error_of([] { return _exit(0), std::string(); }), "crashed"))
      << "an importer that ends the process with success";
  EXPECT_TRUE(contains(error_of([]() -> std::string { throw 1; }), "cannot be read as a mesh"));
  EXPECT_TRUE(contains(error_of([]() -> std::string { throw std::logic_error("odd"); }), "odd"));
}

TEST(IsolatedWorker, AnEndlessLoopIsAnError) {
  ImportLimits limits;
  limits.cpu_seconds = 1;
  volatile bool forever = true;
  const std::string error = error_of(
      [&] {
        while (forever) {
        }
        return std::string();
      },
      limits);
  EXPECT_TRUE(contains(error, "takes more than 1 s")) << error;
  limits.wall_seconds = 1;
  const auto start = std::chrono::steady_clock::now();
  EXPECT_TRUE(contains(error_of([] { return pause(), std::string(); }, limits), "more than 1 s"))
      << "one that waits uses no processor";
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

// Sanitizers refuse what is far too large by themselves.
TEST(IsolatedWorker, TooMuchMemoryIsAnError) {
  ImportLimits limits;
  limits.memory = std::uint64_t(256) << 20;
  const auto greedy = [] {
    std::vector<std::string> all;
    for (int i = 0; i < 64; ++i) all.emplace_back(std::size_t(16) << 20, 'x');
    return std::to_string(all.size());
  };
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
  GTEST_SKIP() << "no limit of the address space under a sanitizer";
#endif
  EXPECT_TRUE(contains(error_of(greedy, limits), "more than 256 MiB")) << error_of(greedy, limits);
  EXPECT_TRUE(contains(error_of(greedy), "no error, but 64")) << error_of(greedy);
}

TEST(IsolatedWorker, WritesNoFileAndLeavesNoProcess) {
  ScratchFolder folder;
  const std::string path = folder / "written";
  error_of([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    write_text_file(path, "x");
    return std::string();
  });
  EXPECT_NE(access(path.c_str(), F_OK), 0);
}

// One child for the files of a folder, another after an error and for another folder.
TEST(IsolatedWorker, StrangersDoNotShareAChild) {
  IsolatedWorker worker("mesh", [](const std::string& request) {
    if (request == "crash") std::signal(SIGSEGV, SIG_DFL), std::raise(SIGSEGV);
    if (request == "refuse") throw InputError({"f", 0, "", "no", "", "", ""});
    return std::to_string(getpid());
  });
  const std::string first = worker.ask("/a/x.obj", "");
  EXPECT_EQ(worker.ask("/a/y.obj", ""), first);
  const std::string other = worker.ask("/b/x.obj", "");
  EXPECT_NE(other, first);
  EXPECT_THROW(worker.ask("/b/y.obj", "crash"), InputError);
  const std::string next = worker.ask("/b/z.obj", "");
  EXPECT_NE(next, other);
  EXPECT_THROW(worker.ask("/b/y.obj", "refuse"), InputError);
  EXPECT_NE(worker.ask("/b/z.obj", ""), next);
  EXPECT_NE(first, std::to_string(getpid()));
}

TEST(IsolatedWorker, AChildReadsTheFilesOfARecording) {
  IsolatedWorker worker("picture", [](const std::string&) { return std::to_string(getpid()); });
  worker.share_folder("/run");
  const std::string first = worker.ask("/run/frames/rgb/0.png", "");
  EXPECT_EQ(worker.ask("/run/cameras/a/frames/depth/0.exr", ""), first);
  const std::string other = worker.ask("/runs/0.png", "");
  EXPECT_NE(other, first);
  EXPECT_EQ(worker.ask("/runs/1.png", ""), other);
  EXPECT_NE(worker.ask("/other/1.png", ""), other);
}

// A lock of a folder would otherwise be held as long as the child lives.
TEST(IsolatedWorker, HoldsNoFileOfTheParent) {
  ScratchFolder folder;
  const int first = open((folder / "lock").c_str(), O_RDWR | O_CREAT, 0666);
  const int file = fcntl(first, F_DUPFD, 200);  // a number that the child has no use for itself
  close(first);
  ASSERT_GE(file, 200);
  const std::string answer = run_isolated("a", "mesh", [file] {
    return std::string(fcntl(file, F_GETFD) < 0 ? "closed" : "open");
  });
  close(file);
  EXPECT_EQ(answer, "closed");
}

TEST(IsolatedWorker, ThreadsMayDoItAtOnce) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "GCC 12's AddressSanitizer holds locks of its allocator over a fork: a child may wait for ever";
#endif
  std::vector<std::thread> threads;
  std::vector<std::string> results(4);
  for (std::size_t i = 0; i < results.size(); ++i)
    threads.emplace_back([&, i] {
      for (int k = 0; k < 10; ++k)
        results[i] = run_isolated("a", "mesh", [&] { return std::string(100000, char('a' + i)); });
    });
  for (std::thread& thread : threads) thread.join();
  for (std::size_t i = 0; i < results.size(); ++i)
    EXPECT_EQ(results[i], std::string(100000, char('a' + i)));
}

// A lock of OpenEXR that another thread holds at the fork would stay locked in the child for ever.
TEST(IsolatedWorker, ReadsWhileOtherThreadsWrite) {
  const ScratchFolder scratch;
  const std::vector<float> values(8 * 8, 1.5f);
  const std::string path = scratch / "a.exr";
  write_text_file(path, encode_exr(8, 8, {"Y"}, values));
  std::atomic<bool> done{false};
  std::vector<std::thread> writers;
  for (int i = 0; i < 4; ++i)
    writers.emplace_back([&] {
      while (!done) encode_exr(8, 8, {"Y"}, values);
    });
  for (int i = 0; i < 300; ++i) EXPECT_EQ(read_exr(path, {"Y"}).values.front(), 1.5) << i;
  done = true;
  for (std::thread& writer : writers) writer.join();
}

}  // namespace isolated_worker_test
}  // namespace rubble
