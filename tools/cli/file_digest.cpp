#include "tools/cli/file_digest.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include "storage/system/file_calls.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

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
  std::vector<std::byte> piece;
  for (std::uint64_t at = 0; at < source.size_bytes(); at += piece.size()) {
    piece.resize(
        static_cast<std::size_t>(std::min<std::uint64_t>(kPieceBytes, source.size_bytes() - at)));
    if (const auto read = source.read_at(at, piece); !read) return read.error();
    if (EVP_DigestUpdate(context.get(), piece.data(), piece.size()) != 1) return no_digest();
  }
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  if (EVP_DigestFinal_ex(context.get(), digest, &length) != 1) return no_digest();
  return hexadecimal(std::span(digest, length));
}

}  // namespace planetree::tools
