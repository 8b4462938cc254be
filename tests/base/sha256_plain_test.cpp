// The SHA-256 of platforms without OpenSSL against that of OpenSSL.
#include <gtest/gtest.h>

#include <string>

// Under another name: the library that is linked here has OpenSSL's.
#define Sha256 PlainSha256
#include "kernel/base/sha256_plain.cpp"
#undef Sha256

namespace rubble {
namespace sha256_plain_test {

std::string plain(const std::string& bytes, std::size_t step) {
  PlainSha256 hash;
  for (std::size_t at = 0; at < bytes.size(); at += step) hash.add(bytes.data() + at, std::min(step, bytes.size() - at));
  return hash.hex();
}

// Every length around the borders of blocks and of the padding, given at once and in parts.
TEST(Sha256Plain, EqualsOpenSsls) {
  std::string bytes;
  std::uint64_t state = 1;
  for (std::size_t size = 0; size < 300; ++size) {
    for (std::size_t step : {std::size_t{1000}, std::size_t{1}, std::size_t{63}})
      EXPECT_EQ(plain(bytes, step), sha256(bytes)) << size << " bytes, " << step << " at a time";
    state = state * 6364136223846793005u + 1442695040888963407u;
    bytes += char(state >> 56);
  }
  // FIPS 180-4's example, so that both cannot be wrong alike.
  EXPECT_EQ(plain("abc", 3), "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_NE(plain("abd", 3), sha256("abc")) << "the control";
}

}  // namespace sha256_plain_test
}  // namespace rubble
