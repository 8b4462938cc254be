#include "bench/calibration.h"

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <limits>
#include <thread>

namespace rubble {
namespace {

// About 12 ms each on the processors of 2020.
constexpr int kIntegerRounds = 2500000, kFloatRounds = 10000, kMemoryRounds = 550000;
constexpr int kTries = 3;

typedef float Lanes __attribute__((vector_size(16)));

// xorshift64* (Vigna 2016), and a sum whose terms depend on its bits.
std::uint64_t work_on_integers(std::uint64_t x) {
  std::uint64_t sum = 0;
  for (int i = 0; i < kIntegerRounds; ++i) {
    x ^= x >> 12, x ^= x << 25, x ^= x >> 27;
    if (((x * 0x2545F4914F6CDD1DULL) >> 63) != 0) {
      sum += x;
    } else {
      sum ^= sum << 7 ^ i;
    }
  }
  return sum;
}

// Sweeps along a chain, each link of which depends on the one before, as a solver's do.
std::uint64_t work_on_floats() {
  Lanes chain[256];
  for (int i = 0; i < 256; ++i) {
    const float f = float(i) / 256;
    chain[i] = Lanes{f, f + 0.25F, f + 0.5F, f + 0.75F};
  }
  Lanes last{1, 2, 3, 4};
  for (int round = 0; round < kFloatRounds; ++round) {
    for (Lanes& link : chain) {
      link = (link + last * 0.5F) / (link * link + 1.25F);
      last = link - last * 0.25F;
    }
  }
  std::uint64_t words[2];
  std::memcpy(words, &last, sizeof words);
  return words[0] ^ words[1];
}

// Each place depends on what was found before, so no line can be fetched ahead of time.
std::uint64_t work_on_memory(std::vector<std::uint64_t>& memory) {
  std::uint64_t at = 1;
  for (int i = 0; i < kMemoryRounds; ++i) {
    std::uint64_t& word = memory[(at * 0x9E3779B97F4A7C15ULL) >> (64 - 19)];
    at += word + 1;
    word = at ^ (at >> 17);
  }
  return at;
}

double read_thread_clock() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * double(t.tv_sec) + 1e-6 * double(t.tv_nsec);
}

// The longest that one of `threads` takes, side by side. unit: ms
double measure_once(int threads, std::vector<std::vector<std::uint64_t>>& memories) {
  std::atomic<int> ready{0};
  std::atomic<std::uint64_t> sum{0};  // somebody might read it: the work has to be done
  std::vector<double> spent(std::size_t(threads), 0.0);
  const auto work = [&](int i) {
    ++ready;
    while (ready.load() < threads) std::this_thread::yield();
    const double start = read_thread_clock();
    sum += do_calibration_work(memories[std::size_t(i)]);
    spent[std::size_t(i)] = read_thread_clock() - start;
  };
  std::vector<std::thread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work, i);
  work(0);
  for (std::thread& other : others) other.join();
  return *std::max_element(spent.begin(), spent.end());
}

std::string format(const char* pattern, const Calibration& c) {
  char text[128];
  std::snprintf(text, sizeof text, pattern, c.one_thread, c.two_threads);
  return text;
}

}  // namespace

std::uint64_t do_calibration_work(std::vector<std::uint64_t>& memory) {
  const std::uint64_t integers = work_on_integers(0x9E3779B97F4A7C15ULL);
  return integers ^ work_on_floats() ^ work_on_memory(memory);
}

// In turns, so that a slow moment of the machine hits both.
Calibration calibrate() {
  std::vector<std::vector<std::uint64_t>> memories(2);
  for (auto& memory : memories) memory.resize(kCalibrationWords);
  Calibration best;
  best.one_thread = best.two_threads = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    best.one_thread = std::min(best.one_thread, measure_once(1, memories));
    best.two_threads = std::min(best.two_threads, measure_once(2, memories));
  }
  return best;
}

std::string calibration_text(const Calibration& calibration) {
  return format("calibration of the machine: %.1f ms on one thread, %.1f ms on two\n", calibration);
}

std::string calibration_csv_header() { return "calibration_1_ms,calibration_2_ms"; }

std::string calibration_csv(const Calibration& calibration) {
  return format("%.2f,%.2f", calibration);
}

}  // namespace rubble
