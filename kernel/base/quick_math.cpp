#include "kernel/base/quick_math.h"

namespace rubble::quick {
namespace {

constexpr double kTwoOverRootPi = 1.1283791670955125739;

// erf and its slope at steps of kStep.
struct ErfTable {
  static constexpr int kPlaces = 97;
  static constexpr double kStep = 1.0 / 16;
  double value[kPlaces], slope[kPlaces];

  ErfTable() {
    for (int i = 0; i < kPlaces; ++i) {
      const double x = i * kStep;
      slope[i] = kTwoOverRootPi * exp(-x * x);
      double term = x, sum = x;  // erf(x) = slope * sum of 2^n x^(2n+1) / (1 3 5 ... (2n+1))
      for (int n = 1; n < 250; ++n) term *= 2 * x * x / (2 * n + 1), sum += term;
      value[i] = slope[i] * sum;
    }
  }
};

}  // namespace

double erf(double x) {
  static const ErfTable table;
  const double away = std::fabs(x);
  if (!(away < 6)) return x != x ? x : x < 0 ? -1.0 : 1.0;
  const int i = int(away / ErfTable::kStep + 0.5);
  const double a = i * ErfTable::kStep, h = away - a;
  // Taylor's series about a: each derivative follows from the two before.
  double before = table.slope[i], now = -2 * a * before, power = h, sum = before * power;
  for (int n = 2; n <= 9; ++n) {
    power *= h / n;
    sum += now * power;
    const double next = -2 * a * now - 2 * (n - 1) * before;
    before = now, now = next;
  }
  const double value = table.value[i] + sum;
  return x < 0 ? -value : value;
}

}  // namespace rubble::quick
