#include "tools/cli/file_digest.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cstddef>
#include <memory>
#include <span>

#include "storage/system/file_calls.h"
#include "storage/system/read_parts.h"

namespace planetree::tools {
namespace {

struct FreeContext {
  void operator()(EVP_MD_CTX* context) const { EVP_MD_CTX_free(context); }
};

Error no_digest() {
  return make_error(ErrorCode::kReadFailed, Error::kNowhere, Error::kNowhere,
                    "SHA-256 is not available; check the installation of OpenSSL");
}

std::string hexadecimal(std::span<const unsigned char> bytes) {
  std::string text;
  for (const unsigned char byte : bytes) text += fmt::format("{:02x}", byte);
  return text;
}

}  // namespace

Result<std::string> sha256_of_file(const std::filesystem::path& path) {
  const auto source = storage::open_file_source(path.c_str(), storage::FileCalls::real());
  return source ? sha256_of(**source) : Result<std::string>(source.error());
}

Result<std::string> sha256_of(const storage::ByteSource& source) {
  const std::unique_ptr<EVP_MD_CTX, FreeContext> context(EVP_MD_CTX_new());
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1) return no_digest();
  bool is_digested = true;
  const auto read = storage::read_parts(source, source.size_bytes(), [&](const auto& part) {
    is_digested = is_digested && EVP_DigestUpdate(context.get(), part.data(), part.size()) == 1;
  });
  if (!read) return read.error();
  if (!is_digested) return no_digest();
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  if (EVP_DigestFinal_ex(context.get(), digest, &length) != 1) return no_digest();
  return hexadecimal(std::span(digest, length));
}

}  // namespace planetree::tools
