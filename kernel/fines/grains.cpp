#include "kernel/fines/grains.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "kernel/base/parallel.h"
#include "kernel/base/portable_math.h"
#include "kernel/fines/resting.h"
#include "kernel/geometry/fine_shapes.h"

namespace rubble {
namespace {

constexpr double kLoneHeaps = 0.2;       // share of heaps that are scattered far
constexpr double kLoneSpread = 0.35;     // of those; unit: m
constexpr double kHeapPower = 1.3;           // heaps of more than n pieces: in proportion to n^-kHeapPower
constexpr double kHighest = 0.3;         // above its site that a grain starts from; unit: m
constexpr double kDeepest = 3;           // that one falls; unit: m
constexpr double kPebbleFrom = 0.005, kStoneFrom = 0.012;  // longest sides; unit: m
constexpr double kStiffFrom = 0.012;     // bodies this long rest on several points; unit: m
constexpr double kStiffGap = 0.3, kFlatGap = 0.1;  // below a part of such a body, as a share of its length
constexpr double kClear = 0.8;           // least distance from other surfaces, in heights of the middle
constexpr double kSplinter = 0.3;        // how slim wood is, beside stone
constexpr int kRounds = 8;               // of heaps, before there is no room
constexpr std::size_t kHeapsAtOnce = 512;  // between two reports of progress

// How a kind comes down. Sizes are of the longest side; unit: m.
struct Manner {
  double least_heap, most_heap;  // pieces of a heap
  double spread;                 // of the smallest heap; unit: m
  double size_min, size_max, exponent;
  double thick_min, thick_max;   // of flat ones; unit: m; 0: not flat
};

Manner manner_of(FineKind kind, const FinesSpec& spec) {
  if (kind == FineKind::plaster) return {2, 30, 0.05, 0.008, 0.11, 2.0, 0.0015, 0.006};
  if (kind == FineKind::glass) return {6, 60, 0.05, 0.004, 0.08, 1.8, 0.003, 0.004};
  return {8, 700, 0.022, spec.size[0], spec.size[1], spec.exponent, 0, 0};
}

// Longer than d: in proportion to d^-exponent, between the ends.
double draw_power(double low, double high, double exponent, RandomStream& random) {
  const double ratio = portable::exp(-exponent * portable::log(high / low));
  const double u = 1 - random.uniform() * (1 - ratio);
  return low * portable::exp(-portable::log(u) / exponent);
}

struct Grain {
  FinePiece piece;
  Vec3 centre;  // in the world; unit: m
};

class GrainStrewer {
 public:
  GrainStrewer(const GrainGround& ground, FineKind kind, const FinesSpec& spec, const WeightedChoice& choice)
      : ground_(ground), kind_(kind), manner_(manner_of(kind, spec)), choice_(choice) {}

  std::vector<Grain> make_heap(std::size_t number) const {
    const std::string& name = fine_names()[std::size_t(kind_)];
    RandomStream random(ground_.options.seed, "fines." + name + "." + std::to_string(number));
    const FineSite& site = ground_.sites[std::size_t(choice_.draw(random))];
    const double count = draw_power(manner_.least_heap, manner_.most_heap, kHeapPower, random);
    const double spread = random.uniform() < kLoneHeaps
                              ? kLoneSpread
                              : manner_.spread * std::sqrt(count / manner_.least_heap) * random.uniform(0.6, 1.6);
    const FineSurface of_heap = ground_.fragments.draw(site.source, random);
    const double lift = std::min(0.6 * site.headroom, kHighest);
    std::vector<Grain> grains;
    for (int i = 0; i < int(count + 0.5); ++i) {
      const Vec3 aside{spread * random.normal(), spread * random.normal(), lift};
      Grain grain;
      if (let_fall(site.point + aside, of_heap, random, grain)) grains.push_back(grain);
    }
    return grains;
  }

 private:
  // Draws as much whether the grain stays or not.
  bool let_fall(const Vec3& from, FineSurface surface, RandomStream& random, Grain& grain) const {
    const double size = draw_power(manner_.size_min, manner_.size_max, manner_.exponent, random);
    const double yaw = random.uniform(-portable::kPi, portable::kPi);
    FinePiece& piece = grain.piece;
    piece.kind = kind_;
    piece.surface = std::uint8_t(kind_ == FineKind::plaster ? FineSurface::plaster
                                 : kind_ == FineKind::glass ? FineSurface::glass
                                                            : surface);
    shape(size, random, piece);
    const auto below = find_below(ground_.queries, from, kDeepest);
    if (!below) return false;
    Support support{below->point, below->normal, below->piece};
    if (size > kStiffFrom) {
      const auto found = find_support(ground_.queries, *below, 0.35 * size, yaw, (is_flat() ? kFlatGap : kStiffGap) * size);
      if (!found) return false;
      support = *found;
    }
    double height = 0;
    const Pose pose = rest_on(support, fine_shape(piece.shape), piece.half, is_flat(), yaw, height);
    const auto nearest = ground_.queries.find_closest(pose.translation, height);
    if (nearest && nearest->distance < kClear * height) return false;
    put(pose, ground_.host_of(support.host), grain);
    return true;
  }

  bool is_flat() const { return manner_.thick_max > 0; }

  void shape(double size, RandomStream& random, FinePiece& piece) const {
    const int number = int(random.below(kShapesOfForm));
    const double narrow = random.uniform(0.6, 0.95), low = random.uniform(0.45, 0.85);
    const double thick = random.uniform(manner_.thick_min, std::max(manner_.thick_min, manner_.thick_max));
    FineForm form = size < kPebbleFrom ? FineForm::chip : size < kStoneFrom ? FineForm::pebble : FineForm::stone;
    if (is_flat()) form = kind_ == FineKind::glass ? FineForm::shard : FineForm::flake;
    piece.shape = std::uint16_t(fine_shape_number(form, number));
    const bool splinter = piece.surface == std::uint8_t(FineSurface::timber);
    const double half = 0.5 * size, across = half * narrow * (splinter ? kSplinter : 1);
    piece.half = Vec3f(Vec3(half, across, is_flat() ? 0.5 * std::min(thick, 0.4 * size) : std::min(across, half * low)));
  }

  void put(const Pose& pose, int host, Grain& grain) const {
    const Pose in_host = world_from_host(ground_.pile, host).inverse() * pose;
    grain.piece.host = host;
    grain.piece.position = Vec3f(in_host.translation), grain.piece.rotation = Quatf(in_host.rotation);
    grain.centre = pose.translation;
  }

  const GrainGround& ground_;
  FineKind kind_;
  Manner manner_;
  const WeightedChoice& choice_;
};

}  // namespace

double calc_site_weight(const FineSite& site, const FinePatches& patches) {
  constexpr double kOpen = 0.15, kFoot = 2, kFades = 0.3;  // the last: on the ground away from the pile; unit: m
  return (kOpen + kFoot * site.corner) * portable::exp(-site.away / kFades) * patches.at(site.point);
}

std::array<int, 5> share_amount(const FinesSpec& spec) {
  const std::array<double, 5> shares{spec.grit, spec.plaster, spec.glass, spec.paper, spec.cloth};
  double sum = 0, before = 0;
  for (const double share : shares) sum += share;
  std::array<int, 5> counts{};
  if (sum <= 0) return counts;
  int given = 0;
  for (std::size_t i = 0; i < shares.size(); ++i) {
    before += shares[i];
    const int up_to = i + 1 == shares.size() ? spec.amount : int(double(spec.amount) * before / sum + 0.5);
    counts[i] = up_to - given, given = up_to;
  }
  return counts;
}

void strew_grains(const GrainGround& ground, FineKind kind, int amount, const FinesSpec& spec, RoomForFines& room,
                  std::vector<FinePiece>& pieces) {
  const FinePatches patches(ground.options.seed);
  std::vector<double> weights;
  double sum = 0;
  for (const FineSite& site : ground.sites) weights.push_back(calc_site_weight(site, patches)), sum += weights.back();
  if (!(sum > 0) || amount <= 0) return;
  const WeightedChoice choice(weights);
  const GrainStrewer strewer(ground, kind, spec, choice);
  const std::size_t before = pieces.size();
  std::size_t heaps = 0;
  int left = amount;
  double of_heap = 8;  // grains that stay, at first a guess
  // What is to go of this round, and full rounds after it.
  const auto report = [&](std::size_t heaps_of_round, int rounds) {
    if (!ground.options.progress) return;
    const double rate = double(amount - left) / double(heaps);
    const double most = double(heaps_of_round) + rounds * double(left) / std::max(1.0, rate);
    const double to_go = rate > 0 ? std::min(double(left) / rate, most) : most;
    const double share = double(heaps) / (double(heaps) + to_go);
    ground.options.progress((double(before) + share * amount) / spec.amount, int(pieces.size()));
  };
  for (int round = 0; round < kRounds && left > 0; ++round) {
    const std::size_t end = heaps + std::size_t(double(left) / of_heap) + 4;
    while (heaps < end && left > 0) {
      std::vector<std::vector<Grain>> made(std::min(kHeapsAtOnce, end - heaps));
      parallel_for(made.size(), ground.options.threads, [&](std::size_t i) { made[i] = strewer.make_heap(heaps + i); });
      heaps += made.size();
      for (const std::vector<Grain>& heap : made)
        for (const Grain& grain : heap) {
          const double radius = double(grain.piece.half.x + grain.piece.half.y) / 2;
          if (left > 0 && room.take(grain.centre, radius)) pieces.push_back(grain.piece), --left;
        }
      report(end - heaps, kRounds - 1 - round);
    }
    of_heap = std::max(1.0, double(amount - left) / double(heaps));
  }
}

}  // namespace rubble
