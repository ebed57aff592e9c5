#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

#include "tests/fuzz/memory_file.h"
#include "tools/points/row_reader.h"

namespace planetree::tools {
namespace {

void expect(bool truth) {
  if (!truth) std::abort();
}

/// What is read from a source of points: all points up to the end or an error.
struct Reading {
  std::vector<Vec3> points;
  std::string error;

  bool operator==(const Reading& other) const {
    return error == other.error && points.size() == other.points.size() &&
           (points.empty() ||
            std::memcmp(points.data(), other.points.data(), points.size() * sizeof(Vec3)) == 0);
  }
};

Reading read(Result<std::unique_ptr<PointReader>> source, std::size_t piece) {
  Reading reading;
  std::vector<Vec3> points(piece);
  Result<std::size_t> count = std::size_t{0};
  do {
    count = source ? (*source)->read(points) : Result<std::size_t>(source.error());
    if (count)
      reading.points.insert(reading.points.end(), points.begin(),
                            points.begin() + static_cast<std::ptrdiff_t>(*count));
  } while (count && *count > 0);
  if (count) return reading;
  expect(count.error().code == ErrorCode::kBadInput ||
         count.error().code == ErrorCode::kBadArgument);
  reading.error = count.error().text;
  expect(!reading.error.empty() && reading.error.find('\n') == std::string::npos);
  return reading;
}

/// The points as CSV with 17 digits.
std::string text_of(const std::vector<Vec3>& points) {
  std::string text;
  for (const Vec3& point : points) {
    char line[96];
    const int length =
        std::snprintf(line, sizeof line, "%.17g,%.17g,%.17g\n", point.x, point.y, point.z);
    text.append(line, static_cast<std::size_t>(length));
  }
  return text;
}

Reading read_file(const std::string& path, const ColumnChoice& choice, std::size_t piece) {
  return read(open_points(path, stdin, choice), piece);
}

Reading read_stream(const std::string& path, const ColumnChoice& choice) {
  std::FILE* const stream = std::fopen(path.c_str(), "rb");
  Reading reading = read(open_points("-", stream, choice), 7);
  std::fclose(stream);
  return reading;
}

}  // namespace
}  // namespace planetree::tools

/// Reads arbitrary bytes as points: the first byte chooses the columns, the others are the file.
/// Pieces of any size and a stream must give the same, and what was read must be read again from
/// its own text.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::tools;
  if (size == 0) return 0;
  constexpr const char* kChoices[] = {"1,2,3", "4,2,3", "x,y,z", "a,B,3"};
  ColumnChoice choice;
  if (bytes[0] % 8 < std::size(kChoices)) choice = *ColumnChoice::parse(kChoices[bytes[0] % 8]);
  const planetree::MemoryFile file(bytes + 1, size - 1);
  const Reading one = read_file(file.path(), choice, 1);
  expect(one == read_file(file.path(), choice, 4096));
  expect(one == read_stream(file.path(), choice));

  const std::string text = text_of(one.points);
  const planetree::MemoryFile copy(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const Reading again = read_file(copy.path(), {}, 64);
  expect(again.error.empty() && again.points.size() == one.points.size());
  // The sign of a NaN may be lost.
  expect(text_of(again.points) == text || text.find("nan") != std::string::npos);
  return 0;
}
