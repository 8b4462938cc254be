// The solver's loops exist for any machine and for each vector unit that this one has: same input, same bits.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <vector>

#include "kernel/base/random.h"
#include "kernel/solver/contact_rows.h"

namespace rubble {
namespace row_kernels_test {

constexpr int kBodies = 80, kBatches = 24;

struct Scene {
  std::vector<Contact> contacts;
  std::vector<BodyTerms> terms = std::vector<BodyTerms>(kBodies + 1);  // the last does not move
  std::vector<PaddedMotion> speeds = std::vector<PaddedMotion>(kBodies + 1), moved = speeds;
  std::vector<ContactBatch> batches;
  std::vector<NormalRow> rows;
  std::vector<PushRow> pushes;

  BatchRange range() {
    return {batches.data(), batches.data() + batches.size(), rows.data(), pushes.data()};
  }
};

class Maker {
 public:
  float number(double low, double high) { return float(random_.uniform(low, high)); }
  Vec3f vector(double size) {
    return {number(-size, size), number(-size, size), number(-size, size)};
  }
  Quad quad(double size) {
    const Vec3f v = vector(size);
    return Quad{v.x, v.y, v.z, 0};
  }

  Contact contact(int points) {
    Contact c;
    c.count = points;
    c.points.make();
    c.normal = number(0, 1) < 0.2F ? Vec3f{0, 0, 1} : normalized(vector(1));
    c.friction = number(0, 1);
    c.friction_impulse = vector(0.3);
    c.twist_impulse = number(-0.1, 0.1);
    for (int i = 0; i < points; ++i) {
      ContactPoint& p = c.points[i];
      p.from_a = vector(0.4), p.from_b = vector(0.4);
      p.separation = number(-0.003, 0.004);
      p.normal_impulse = number(0, 1) < 0.3F ? 0 : number(0, 1);
    }
    return c;
  }

  Scene scene() {
    Scene s;
    for (int i = 0; i < kBodies; ++i) {
      BodyTerms& t = s.terms[i];
      t.mass = number(1, 300), t.share = number(0.05, 1), t.inverse_mass = 1 / t.mass;
      t.row0[0] = number(0.01, 1), t.row1[1] = number(0.01, 1), t.row2[2] = number(0.01, 1);
      t.row0[1] = t.row1[0] = number(-0.004, 0.004);
      t.row0[2] = t.row2[0] = number(-0.004, 0.004);
      s.speeds[i] = {quad(2), quad(4)};
      s.moved[i] = {quad(0.01), quad(0.02)};
    }
    // With a packet of eight that is empty, one that is not full, and none of these.
    constexpr int kUsed[] = {kLanes, 5, kLanes, 13, kLanes};
    for (int k = 0; k < kBatches; ++k) add_batch(s, k % Contact::kMaxPoints + 1, kUsed[k % 5]);
    s.rows.resize(std::size_t(rows_)), s.pushes.resize(std::size_t(rows_));
    return s;
  }

 private:
  void add_batch(Scene& s, int points, int used) {
    ContactBatch batch{};
    batch.first_row = rows_, batch.rows = points, batch.used = used;
    rows_ += points;
    const int first = int(random_.below(kBodies));
    for (int lane = 0; lane < kLanes; ++lane) {
      batch.a[lane] = batch.b[lane] = kBodies;
      batch.contact[lane] = -1;
      if (lane >= used) continue;
      batch.a[lane] = (first + 2 * lane) % kBodies;
      if (lane % 3 != 0) batch.b[lane] = (first + 2 * lane + 1) % kBodies;
      batch.contact[lane] = int(s.contacts.size());
      s.contacts.push_back(contact(points));
    }
    s.batches.push_back(batch);
  }

  RandomStream random_{7, "rows"};
  int rows_ = 0;
};

void run(const RowKernels& kernels, Scene& s) {
  kernels.prepare(s.range(), s.contacts.data(), s.terms.data(), 0.001F);
  for (int substep = 0; substep < 4; ++substep) {
    kernels.warm_start(s.range(), s.speeds.data());
    kernels.solve_velocities(s.range(), substep % 2 != 0, 960, 0.01F, s.moved.data(), s.speeds.data());
  }
  for (ContactBatch& batch : s.batches) {
    NormalRow* rows = &s.rows[std::size_t(batch.first_row)];
    PushRow* pushes = &s.pushes[std::size_t(batch.first_row)];
    kernels.begin_pushes(batch, rows, pushes, {0.0003F, 0.2F, 0.02F}, s.moved.data());
    kernels.solve_pushes(batch, rows, pushes, s.moved.data());
  }
}

template <typename T>
::testing::AssertionResult same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  const auto *p = reinterpret_cast<const float*>(a.data()), *q = reinterpret_cast<const float*>(b.data());
  for (std::size_t i = 0; i < a.size() * sizeof(T) / sizeof(float); ++i) {
    if (std::memcmp(p + i, q + i, sizeof(float)) == 0) continue;
    return ::testing::AssertionFailure() << "number " << i << ": " << p[i] << " and " << q[i];
  }
  return ::testing::AssertionSuccess();
}

// What is in lanes without a contact is nothing: packets without any are not computed.
void clear_unused(Scene& s) {
  const auto clear = [](auto& lanes, std::size_t size, int used) {
    auto* at = reinterpret_cast<Lanes*>(&lanes);
    for (std::size_t i = 0; i < size / sizeof(Lanes); ++i) std::fill(at[i].lane + used, at[i].lane + kLanes, 0.0F);
  };
  for (ContactBatch& batch : s.batches) {
    constexpr std::size_t kBefore = offsetof(ContactBatch, inverse_mass_a);
    clear(batch.inverse_mass_a, sizeof batch - kBefore, batch.used);
    for (int i = batch.first_row; i < batch.first_row + batch.rows; ++i) {
      clear(s.rows[std::size_t(i)], sizeof(NormalRow), batch.used);
      clear(s.pushes[std::size_t(i)], sizeof(PushRow), batch.used);
    }
  }
}

TEST(RowKernels, EveryMachineComputesTheSameBits) {
  Scene portable = Maker().scene();
  run(portable_row_kernels(), portable);
  clear_unused(portable);
  for (const RowKernels* kernels : all_row_kernels()) {
    Scene other = Maker().scene();
    run(*kernels, other);
    clear_unused(other);
    EXPECT_TRUE(same_bits(portable.speeds, other.speeds));
    EXPECT_TRUE(same_bits(portable.moved, other.moved));
    EXPECT_TRUE(same_bits(portable.rows, other.rows));
    EXPECT_TRUE(same_bits(portable.pushes, other.pushes));
    EXPECT_TRUE(same_bits(portable.batches, other.batches));
  }
  // And that something was computed.
  EXPECT_FALSE(same_bits(portable.speeds, Maker().scene().speeds));
  for (const PaddedMotion& m : portable.speeds) EXPECT_TRUE(std::isfinite(m.linear[0] + m.angular[0]));
  EXPECT_EQ(portable.speeds[kBodies].linear[2], 0);
}

// Who shares a batch must not change the result.
TEST(RowKernels, ContactsDoNotFeelTheOthersOfTheirBatch) {
  const ContactBatch first = Maker().scene().batches[3];
  for (int lane = 0; lane < kLanes; ++lane) {
    if (first.contact[lane] < 0) continue;
    Scene one = Maker().scene(), all = Maker().scene();
    all.batches = one.batches = {first};
    ContactBatch& batch = one.batches.front();
    for (int other = 0; other < kLanes; ++other) {
      batch.a[other] = batch.b[other] = kBodies;
      batch.contact[other] = -1;
    }
    // In another lane than before.
    batch.a[0] = first.a[lane], batch.b[0] = first.b[lane], batch.contact[0] = first.contact[lane];
    batch.used = 1;
    run(best_row_kernels(), one);
    run(best_row_kernels(), all);
    for (int body : {first.a[lane], first.b[lane]}) {
      if (body == kBodies) continue;
      EXPECT_EQ(std::memcmp(&one.speeds[std::size_t(body)], &all.speeds[std::size_t(body)],
                            sizeof(PaddedMotion)), 0) << "lane " << lane;
    }
  }
}

}  // namespace row_kernels_test
}  // namespace rubble
