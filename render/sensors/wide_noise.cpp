// Noise of several places at a time: the formulas of NoiseField with a place in each lane, and the same bits.
#include <cmath>
#include <cstring>

#include "render/geometry/wide.h"
#include "render/sensors/noise_field.h"

namespace rubble::RUBBLE_ISA {
namespace {

constexpr int kPlaces = kWidth / 2;  // of a register
typedef double Double __attribute__((vector_size(kWidth * 4)));
typedef std::int64_t Long __attribute__((vector_size(kWidth * 4)));
typedef std::uint64_t Bits __attribute__((vector_size(kWidth * 4)));
typedef std::uint32_t HalfWords __attribute__((vector_size(kWidth * 2)));  // one for each place

constexpr double kShift = 0x1.8p52;  // added to a small whole number, leaves it in the last bits
constexpr std::int64_t kShiftBits = 0x4338000000000000;

RUBBLE_INLINE bool any(Long m) { return RUBBLE_ISA::any(Mask(m)); }
RUBBLE_INLINE Double root(Double x) {
#if defined(__AVX512F__)
  return Double(_mm512_sqrt_pd(__m512d(x)));
#elif defined(__AVX2__)
  return Double(_mm256_sqrt_pd(__m256d(x)));
#elif defined(__x86_64__)
  return Double(_mm_sqrt_pd(__m128d(x)));
#else
  Double out;
  for (int i = 0; i < kPlaces; ++i) out[i] = std::sqrt(x[i]);
  return out;
#endif
}
RUBBLE_INLINE Double round_down(Double x) {
#if defined(__AVX512F__)
  return Double(_mm512_roundscale_pd(__m512d(x), 0x09));
#elif defined(__AVX2__)
  return Double(_mm256_floor_pd(__m256d(x)));
#else
  Double out;
  for (int i = 0; i < kPlaces; ++i) out[i] = std::floor(x[i]);
  return out;
#endif
}

// Of whole numbers: exact.
RUBBLE_INLINE Double small_to_double(Long x) { return Double(x + kShiftBits) - kShift; }  // range: |x| < 2^51
RUBBLE_INLINE Long double_to_small(Double x) { return Long(x + kShift) - kShiftBits; }
RUBBLE_INLINE Double to_double(Bits x) {  // range: up to 2^53
  const Double high = Double((x >> 32) | 0x4530000000000000u), low = Double((x & 0xffffffffu) | 0x4330000000000000u);
  return (high - 0x1p84) + (low - 0x1p52);
}
// As quick::detail::round: halves away from zero.
RUBBLE_INLINE Double nearest_whole(Double x) {
  const Double sign = Double(Bits(x) & 0x8000000000000000u), size = Double(Bits(x) & 0x7fffffffffffffffu) + 0.5;
  const Double near = (size + kShift) - kShift;
  return Double(Bits(near > size ? near - 1.0 : near) | Bits(sign));
}

RUBBLE_INLINE Double lane_exp(Double x) {  // range: as of quick::exp, not checked
  const Double k = nearest_whole(x * quick::kLog2E);
  const Double r = (x - k * 0x1.62e42fefp-1) - k * 0x1.473de6af278edp-34;
  return (1.0 + r * quick::detail::exp_series(r)) * Double((double_to_small(k) + 1023) << 52);
}
RUBBLE_INLINE Double lane_log(Double x) {  // range: normal, above 0
  const Bits moved = Bits(x) - 0x3fe6a09e667f3bcdu;
  const Double e = small_to_double(Long(moved) >> 52);
  const Double m = Double((moved & 0x000fffffffffffffu) + 0x3fe6a09e667f3bcdu);
  return e * 0x1.62e42fefp-1 + (e * 0x1.473de6af278edp-34 + quick::detail::log_series((m - 1.0) / (m + 1.0)));
}
RUBBLE_INLINE Double lane_cos(Double x) {  // range: |x| <= 1e6
  const Double whole = nearest_whole(x * 0.63661977236758134308);
  const Double r = ((x - whole * 0x1.921fb544p+0) - whole * 0x1.0b4611a6p-34) - whole * 0x1.3198a2e037073p-69;
  const Long k = double_to_small(whole);
  const Double size = (k & 1) != 0 ? quick::detail::sin_series(r) : quick::detail::cos_series(r);
  return Double(Bits(size) ^ (Bits((k + 1) & 2) << 62));
}

RUBBLE_INLINE Bits bits_at(std::uint64_t key, Bits place) { return NoiseField::mix(key + place * NoiseField::kStep); }
RUBBLE_INLINE Double uniform_at(std::uint64_t key, Bits place) { return to_double(bits_at(key, place) >> 11) * 0x1p-53; }
RUBBLE_INLINE Double normal_at(std::uint64_t key, Bits place) {
  const Double u = to_double((bits_at(key, 2 * place) >> 11) + 1) * 0x1p-53, v = uniform_at(key, 2 * place + 1);
  return root(-2.0 * lane_log(u)) * lane_cos(2 * portable::kPi * v);
}
RUBBLE_INLINE Double poisson_at(std::uint64_t key, Bits place, Double mean) {
  const Long some = mean > 0.0, many = mean > 30.0;
  Double out = {};
  if (any(many)) {
    const Double z = normal_at(key, place);
    const Double value = mean + root(many ? mean : Double{}) * z + (z * z - 1.0) / 6.0;
    out = (many & (value > 0.0)) ? round_down(value + 0.5) : out;
  }
  const Long few = some & ~many;
  if (!any(few)) return out;
  const Double of_few = few ? mean : Double{};
  Double p = lane_exp(-of_few), left = uniform_at(key, 2 * place) - p, count = {};
  for (Long going = few & (left >= 0.0); any(going); going &= (left >= 0.0) & (count < 200.0)) {
    count = going ? count + 1.0 : count;
    p = going ? p * (of_few / count) : p;
    left = going ? left - p : left;
  }
  return few ? count : out;
}

// The last register is perhaps not full: its other lanes are 0.
template <typename Lanes, typename Number>
RUBBLE_INLINE Lanes load(const Number* from, std::size_t count) {
  Lanes out = {};
  if (count >= std::size_t(kPlaces)) {
    std::memcpy(&out, from, sizeof out);
  } else {
    for (std::size_t k = 0; k < count; ++k) out[k] = from[k];
  }
  return out;
}
RUBBLE_INLINE void store(Double lanes, std::size_t count, double* to) {
  if (count >= std::size_t(kPlaces)) {
    std::memcpy(to, &lanes, sizeof lanes);
  } else {
    for (std::size_t k = 0; k < count; ++k) to[k] = lanes[k];
  }
}
RUBBLE_INLINE Bits load_places(const std::uint32_t* from, std::size_t count) {
  return __builtin_convertvector(load<HalfWords>(from, count), Bits);
}

void normal(std::uint64_t key, const std::uint32_t* places, std::size_t count, double* out) {
  for (std::size_t i = 0; i < count; i += std::size_t(kPlaces))
    store(normal_at(key, load_places(places + i, count - i)), count - i, out + i);
}

void poisson(std::uint64_t key, const std::uint32_t* places, const double* means, std::size_t count, double* out) {
  for (std::size_t i = 0; i < count; i += std::size_t(kPlaces))
    store(poisson_at(key, load_places(places + i, count - i), load<Double>(means + i, count - i)), count - i, out + i);
}

}  // namespace

extern const NoiseLanes kNoiseLanes;
const NoiseLanes kNoiseLanes = {RUBBLE_NAME_OF_ISA, normal, poisson};

}  // namespace rubble::RUBBLE_ISA
