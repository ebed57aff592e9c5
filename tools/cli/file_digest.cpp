#include "tools/cli/file_digest.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <span>
#include <vector>

#include "storage/system/file_error.h"

namespace planetree::tools {
namespace {

constexpr std::size_t kPieceBytes = std::size_t{1} << 20;

struct CloseFile {
  void operator()(std::FILE* file) const { std::fclose(file); }
};
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
  const std::unique_ptr<std::FILE, CloseFile> file(std::fopen(path.c_str(), "rbe"));
  if (!file) return storage::file_error(errno, storage::FileAction::kRead, "open the file");
  const std::unique_ptr<EVP_MD_CTX, FreeContext> context(EVP_MD_CTX_new());
  if (!context || EVP_DigestInit_ex(context.get(), EVP_sha256(), nullptr) != 1) return no_digest();
  std::vector<unsigned char> piece(kPieceBytes);
  for (;;) {
    const std::size_t bytes = std::fread(piece.data(), 1, piece.size(), file.get());
    if (bytes == 0) break;
    if (EVP_DigestUpdate(context.get(), piece.data(), bytes) != 1) return no_digest();
  }
  if (std::ferror(file.get()) != 0)
    return storage::file_error(errno, storage::FileAction::kRead, "read the file");
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned length = 0;
  if (EVP_DigestFinal_ex(context.get(), digest, &length) != 1) return no_digest();
  return hexadecimal(std::span(digest, length));
}

}  // namespace planetree::tools
