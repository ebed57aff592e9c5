#include <algorithm>
#include <cstdlib>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tools/points/points_fixture.h"

// Files in all combinations of separators, headers, comments, numbers and line ends, and a second
// parser that is told how they are written.
namespace planetree::tools {
namespace {

struct Style {
  const char* separator;  ///< what is written between fields
  const char* line_end;
  bool decimal_comma;
  bool quoted;
  bool counted;
  bool commented;
  int header;
};

constexpr const char* kSeparators[] = {",", ", ", ";", " ; ", "\t", " ", "   ", " \t "};
constexpr const char* kLineEnds[] = {"\n", "\r\n", "\r"};

/// The names of the columns, and which of them are x, y and z.
struct Columns {
  std::vector<std::string> names;
  std::size_t x, y, z;
  const char* before;  ///< what is in front of the header
};
const std::vector<Columns> kHeaders = {{{}, 0, 1, 2, ""},
                                       {{"x", "y", "z"}, 0, 1, 2, ""},
                                       {{"id", "Z[m]", "Y[m]", "X[m]"}, 3, 2, 1, ""},
                                       {{"X", "Y", "Z", "R", "G", "B"}, 0, 1, 2, "//"},
                                       {{"t", "pos_x", "pos_y", "pos_z", "w"}, 1, 2, 3, "# "},
                                       {{"t", "Points:0", "Points:1", "Points:2"}, 1, 2, 3, ""},
                                       {{"northing", "easting", "height", "code"}, 1, 0, 2, ""}};

bool has_comma(const Style& style) { return std::string(style.separator).find(',') == 0; }

class Writer {
 public:
  explicit Writer(const Style& style) : style_(style), random_(7919) {}

  std::string text() {
    const Columns& columns = kHeaders[static_cast<std::size_t>(style_.header)];
    const std::size_t width = std::max<std::size_t>(columns.names.size(), 3);
    if (style_.counted) line("16");
    if (style_.commented) line("# measured on Monday, in metres; see the log");
    if (!columns.names.empty()) line(columns.before + joined(columns.names));
    for (int row = 0; row < 16; ++row) {
      std::vector<std::string> fields(width);
      for (std::string& field : fields) field = number();
      line(joined(fields));
      if (row % 7 == 3) line("");
      if (style_.commented && row % 9 == 4) line("  // a pause, of 1 2 3 minutes");
    }
    return text_;
  }

 private:
  void line(const std::string& content) { text_ += content + style_.line_end; }
  std::string joined(const std::vector<std::string>& fields) const {
    std::string all;
    for (std::size_t i = 0; i < fields.size(); ++i)
      all += (i > 0 ? style_.separator : "") + (style_.quoted ? '"' + fields[i] + '"' : fields[i]);
    return all;
  }
  std::string number() {
    std::ostringstream text;
    text.precision(1 + static_cast<int>(random_() % 17));
    text << std::fixed << std::uniform_real_distribution<double>(-1000, 1000)(random_);
    if (random_() % 5 == 0) text << (random_() % 2 == 0 ? "e-3" : "E+02");
    std::string number = text.str();
    if (style_.decimal_comma) std::replace(number.begin(), number.end(), '.', ',');
    return number;
  }

  Style style_;
  std::minstd_rand random_;
  std::string text_;
};

/// Parses by searching for digits alone: a field is a longest piece of the characters of numbers.
std::vector<std::vector<double>> parse(const std::string& text, const Style& style) {
  const std::string numeric = style.decimal_comma ? "0123456789+-eE," : "0123456789+-eE.";
  const Columns& columns = kHeaders[static_cast<std::size_t>(style.header)];
  std::vector<std::vector<double>> points;
  int skipped = (columns.names.empty() || *columns.before != 0 ? 0 : 1) + (style.counted ? 1 : 0);
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
    const std::string line = text.substr(begin, end - begin);
    begin = end + 1;
    if (line.empty() || line.find('#') == 0 || line.find("//") != std::string::npos) continue;
    if (skipped-- > 0) continue;
    std::vector<double> values;
    for (std::size_t at = 0; (at = line.find_first_of(numeric, at)) != std::string::npos;) {
      const std::size_t stop = std::min(line.find_first_not_of(numeric, at), line.size());
      std::string field = line.substr(at, stop - at);
      std::replace(field.begin(), field.end(), ',', '.');
      values.push_back(std::strtod(field.c_str(), nullptr));
      at = stop;
    }
    points.push_back({values.at(columns.x), values.at(columns.y), values.at(columns.z)});
  }
  return points;
}

TEST_F(Points, AgreeWithAParserThatKnowsTheStyle) {
  int files = 0;
  for (const char* separator : kSeparators)
    for (const char* line_end : kLineEnds)
      for (int header = 0; header < static_cast<int>(kHeaders.size()); ++header)
        for (int flags = 0; flags < 16; ++flags) {
          const Style style = {
              separator,        line_end, (flags & 1) != 0, (flags & 2) != 0, (flags & 4) != 0,
              (flags & 8) != 0, header};
          if (style.decimal_comma && has_comma(style)) continue;
          const std::string text = Writer(style).text();
          const auto expected = parse(text, style);
          ASSERT_EQ(expected.size(), 16u);
          expect_points(read("a.txt", text, 1 + static_cast<std::size_t>(files % 50)), expected);
          ASSERT_FALSE(HasFailure()) << text.substr(0, 400);
          ++files;
        }
  EXPECT_EQ(files, 3 * 7 * (2 * 8 + 6 * 16));
}

}  // namespace
}  // namespace planetree::tools
