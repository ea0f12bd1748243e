#include "sync/mask/file_digest.h"

#include <openssl/evp.h>

#include <cstdio>
#include <memory>
#include <vector>

#include "base/error.h"

namespace venato::sync {

std::string file_sha256(const std::filesystem::path& path) {
  constexpr std::size_t piece = 1 << 20;
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::fopen(path.c_str(), "rb"), &std::fclose);
  if (!file) throw WorkError(path.string() + ": cannot be read back");
  const std::unique_ptr<EVP_MD_CTX, void (*)(EVP_MD_CTX*)> state(EVP_MD_CTX_new(), &EVP_MD_CTX_free);
  if (!state || EVP_DigestInit_ex(state.get(), EVP_sha256(), nullptr) != 1) throw WorkError("SHA-256 is not available");
  std::vector<unsigned char> buffer(piece);
  for (std::size_t n; (n = std::fread(buffer.data(), 1, piece, file.get())) > 0;) EVP_DigestUpdate(state.get(), buffer.data(), n);
  if (std::ferror(file.get())) throw WorkError(path.string() + ": cannot be read back");
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  EVP_DigestFinal_ex(state.get(), digest, &length);
  std::string hex;
  for (unsigned k = 0; k < length; ++k) {
    constexpr char digits[] = "0123456789abcdef";
    hex += digits[digest[k] >> 4];
    hex += digits[digest[k] & 15];
  }
  return hex;
}

}  // namespace venato::sync
