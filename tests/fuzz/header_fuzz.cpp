#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "storage/file/page_file.h"
#include "tests/fuzz/memory_file.h"
#include "tests/storage/file/file_image.h"

/// Opens arbitrary bytes as a .ptree file and reads every page.
///
/// The first byte selects the hashes that are corrected before that; without this no input would
/// get past them.
namespace planetree::storage {
namespace {

constexpr std::uint8_t kSealPages = 1;
constexpr std::uint8_t kSealDirectory = 2;
constexpr std::uint8_t kSealHeader = 4;
constexpr std::uint8_t kSealLength = 8;
constexpr std::uint8_t kSealMagic = 16;

void seal(FileImage& image, std::uint8_t how) {
  if (image.bytes().size() < kHeaderBytes) return;
  image.change_header([&](FileHeader& header) {
    if ((how & kSealLength) != 0) header.file_bytes = image.bytes().size();
    if ((how & kSealMagic) == 0) return;
    std::copy_n(kMagic, sizeof kMagic, header.magic);
    header.version = kFormatVersion;
    header.header_bytes = kHeaderBytes;
    header.incompatible_features = 0;
  });
  if (image.directory_fits() && (how & kSealPages) != 0) image.seal_pages();
  if (image.directory_fits() && (how & kSealDirectory) != 0) {
    image.seal_extensions();
    image.seal_directory();
  }
  if ((how & kSealHeader) != 0) image.seal_header();
}

void read_all_pages(const PageFile& file) {
  Bytes scratch(file.header().max_stored_bytes);
  for (std::uint32_t page = 0; page < file.page_count(); ++page) {
    // A buffer of exactly the page's size, so that a sanitizer reports any access beyond.
    const Result<PageEntry> entry = file.entry(page);
    if (!entry) continue;
    Bytes raw(entry->raw_bytes);
    const Result<void> read = file.read_page(page, scratch, raw);
    if (!read && read.error().page != page) std::abort();
  }
}

void open_and_read(std::span<const std::byte> bytes) {
  const MemoryFile memory(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size());
  const Result<PageFile> file = PageFile::open(memory.path());
  if (file) {
    read_all_pages(*file);
    for (const ExtensionRecord& record : file->extensions())
      static_cast<void>(file->read_extension(record));
  } else if (file.error().text[0] == 0) {
    std::abort();
  }
}

}  // namespace
}  // namespace planetree::storage

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace planetree::storage;
  if (size == 0) return 0;
  const auto* bytes = reinterpret_cast<const std::byte*>(data);
  FileImage image(Bytes(bytes + 1, bytes + size));
  seal(image, data[0]);
  open_and_read(image.bytes());
  return 0;
}
