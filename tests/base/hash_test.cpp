#include "kernel/base/hash.h"

#include <gtest/gtest.h>

namespace rubble {
namespace hash_test {

// Known answers from FIPS 180-4 and from the xxHash specification's reference program.
TEST(Hash, GivesKnownAnswers) {
  EXPECT_EQ(sha256("abc"), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(hex64(hash64("")), "ef46db3751d8e999");
}

TEST(StateHash, SeesTheLastBitAndTheSignOfZero) {
  const auto hash = [](double x) {
    StateHash h;
    h.add(x);
    return h.digest();
  };
  EXPECT_EQ(hash(1.0), hash(1.0));
  EXPECT_NE(hash(1.0), hash(1.0 + 0x1p-52));
  EXPECT_NE(hash(0.0), hash(-0.0));
}

}  // namespace hash_test
}  // namespace rubble
