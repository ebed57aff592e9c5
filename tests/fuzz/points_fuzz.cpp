#include <array>
#include <bit>
#include <cstdio>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "tests/fuzz/expectation.h"
#include "tests/fuzz/memory_file.h"
#include "tools/points/row_reader.h"

namespace planetree::tools {
namespace {

/// What is read from a source of points, rays or sweeps: all rows up to the end or an error.
template <class Row>
struct Reading {
  std::vector<Row> rows;
  std::size_t numbers = 0;  // of a row in the source
  std::string error;

  bool operator==(const Reading& other) const {
    return error == other.error && rows.size() == other.rows.size() &&
           (rows.empty() ||
            std::memcmp(rows.data(), other.rows.data(), rows.size() * sizeof(Row)) == 0);
  }
};

template <class Row>
using Open = Result<std::unique_ptr<RowReader<Row>>>(const std::string&, std::FILE*,
                                                     const ColumnChoice&);

template <class Row>
Reading<Row> read(const Result<std::unique_ptr<RowReader<Row>>>& source, std::size_t piece) {
  Reading<Row> reading;
  std::vector<Row> rows(piece);
  Result<std::size_t> count = std::size_t{0};
  do {
    count = source ? (*source)->read(rows) : Result<std::size_t>(source.error());
    if (source) reading.numbers = (*source)->numbers();
    if (count)
      reading.rows.insert(reading.rows.end(), rows.begin(),
                          rows.begin() + static_cast<std::ptrdiff_t>(*count));
  } while (count && *count > 0);
  if (count) return reading;
  expect(count.error().code == ErrorCode::kBadInput ||
         count.error().code == ErrorCode::kBadArgument);
  reading.error = count.error().text;
  expect(!reading.error.empty() && reading.error.find('\n') == std::string::npos);
  return reading;
}

/// The rows as CSV with 17 digits.
template <class Row>
std::string text_of(const Reading<Row>& reading) {
  std::string text;
  for (const Row& row : reading.rows) {
    const auto numbers = std::bit_cast<std::array<double, RowReader<Row>::kNumbers>>(row);
    for (std::size_t i = 0; i < reading.numbers; ++i) {
      char field[32];
      const int length = std::snprintf(field, sizeof field, "%.17g%c", numbers[i],
                                       i + 1 < reading.numbers ? ',' : '\n');
      text.append(field, static_cast<std::size_t>(length));
    }
  }
  return text;
}

template <class Row>
Reading<Row> read_stream(Open<Row>& open, const std::string& path, const ColumnChoice& choice) {
  std::FILE* const stream = std::fopen(path.c_str(), "rb");
  Reading<Row> reading = read<Row>(open("-", stream, choice), 7);
  std::fclose(stream);
  return reading;
}

/// Pieces of any size and a stream must give the same, and what was read must be read again from
/// its own text.
template <class Row>
void check(Open<Row>& open, const std::string& path, const ColumnChoice& choice) {
  const Reading<Row> one = read<Row>(open(path, stdin, choice), 1);
  expect(one == read<Row>(open(path, stdin, choice), 4096));
  expect(one == read_stream<Row>(open, path, choice));

  const std::string text = text_of(one);
  const MemoryFile copy(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
  const Reading<Row> again = read<Row>(open(copy.path(), stdin, {}), 64);
  expect(again.error.empty() && again.rows.size() == one.rows.size());
  // The sign of a NaN may be lost.
  expect(text_of(again) == text || text.find("nan") != std::string::npos);
}

/// The choice that a byte stands for, if it stands for one.
ColumnChoice choice_of(unsigned byte, const std::vector<const char*>& texts,
                       const RowShape& shape) {
  return byte < texts.size() ? *ColumnChoice::parse(texts[byte], shape) : ColumnChoice();
}

}  // namespace
}  // namespace planetree::tools

/// Reads arbitrary bytes as points, rays or sweeps: the first byte chooses what and the columns,
/// the others are the file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
  using namespace planetree::tools;
  if (size == 0) return 0;
  const planetree::MemoryFile file(bytes + 1, size - 1);
  const unsigned choice = bytes[0] % 8;
  switch (bytes[0] / 8 % 3) {
    case 0:
      check<planetree::Vec3>(open_points, file.path(),
                             choice_of(choice, {"1,2,3", "4,2,3", "x,y,z", "a,B,3"}, kPointShape));
      break;
    case 1:
      check<planetree::Ray>(
          open_rays, file.path(),
          choice_of(choice,
                    {"1,2,3,4,5,6", "8,7,6,5,4,3,2,1", "x,y,z,dx,dy,dz,t_max", "a,B,c,4,5,6"},
                    kRayShape));
      break;
    default:
      check<planetree::Sweep>(
          open_sweeps, file.path(),
          choice_of(choice, {"1,2,3,4,5,6,7", "x0,y0,z0,x1,y1,z1,radius"}, kSweepShape));
  }
  return 0;
}
