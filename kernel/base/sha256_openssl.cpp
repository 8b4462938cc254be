// SHA-256 by OpenSSL, which uses what the processor has for it.
#include <openssl/evp.h>

#include "kernel/base/hash.h"
#include "kernel/base/hex_bytes.h"

namespace rubble {

struct Sha256::State {
  EVP_MD_CTX* context = EVP_MD_CTX_new();
  ~State() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : state_(std::make_unique<State>()) {
  EVP_DigestInit_ex(state_->context, EVP_sha256(), nullptr);
}
Sha256::~Sha256() = default;
void Sha256::add(const void* data, std::size_t size) {
  EVP_DigestUpdate(state_->context, data, size);
}
std::string Sha256::hex() {
  unsigned char bytes[EVP_MAX_MD_SIZE];
  unsigned size = 0;
  EVP_DigestFinal_ex(state_->context, bytes, &size);
  return hex_of_bytes(bytes, size);
}

}  // namespace rubble
