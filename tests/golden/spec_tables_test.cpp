// The tables of the specification describe the structs, row by row.

#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <regex>
#include <string>

#include "octree/geometry/octcode.h"
#include "octree/page/page_streams.h"
#include "planetree/attributes.h"
#include "storage/file/file_layout.h"
#include "tests/golden/format_fields.h"
#include "tests/golden/spec_text.h"

namespace planetree::golden {

// Prints a field in messages of failed tests.
void PrintTo(const FormatField& field, std::ostream* out) {
  *out << field.name << " at " << field.offset << ", " << field.size << " bytes, "
       << field.encoding;
}

namespace {

SpecTable byte_table(const FormatStruct& format) {
  std::size_t others = format.table;
  for (const SpecTable& table : spec_tables(format.heading))
    if (!table.heads.empty() && table.heads.front() == "offset" && others-- == 0) return table;
  ADD_FAILURE() << "no byte table in " << format.heading;
  return {};
}

std::vector<FormatField> stated_fields(const FormatStruct& format) {
  std::vector<FormatField> fields;
  for (const TableRow& row : byte_table(format).rows)
    fields.push_back({row.at(2), std::stoul(row.at(0)), std::stoul(row.at(1)), row.at(4)});
  return fields;
}

TEST(SpecTables, StateEveryFieldOfEveryStruct) {
  for (const FormatStruct& format : format_structs())
    EXPECT_EQ(stated_fields(format), format.fields) << format.heading;
}

// A field that is missing from the list would leave a gap.
TEST(SpecTables, CoverEveryByteOfEveryStruct) {
  for (const FormatStruct& format : format_structs()) {
    std::size_t end = 0;
    for (const FormatField& field : format.fields) {
      EXPECT_EQ(field.offset, end) << format.heading << ": " << field.name;
      end = field.offset + field.size;
    }
    EXPECT_EQ(end, format.size) << format.heading;
  }
}

TEST(SpecTables, HaveTheirColumns) {
  const TableRow heads = {"offset", "size", "field", "meaning", "encoding", "valid range"};
  for (const FormatStruct& format : format_structs()) {
    const SpecTable table = byte_table(format);
    EXPECT_EQ(table.heads, heads) << format.heading;
    for (const TableRow& row : table.rows) EXPECT_EQ(row.size(), heads.size()) << row.front();
  }
}

std::string read_source(const std::string& path) {
  std::ifstream stream(PLANETREE_SOURCE_DIR "/" + path);
  return {std::istreambuf_iterator<char>(stream), {}};
}

// The list of streams in a header, in order. Its lines are "///   name   element".
std::vector<std::string> coded_streams(const std::string& header) {
  const std::string source = read_source(header);
  const std::regex line(R"(\n///     (\w+(?: \w+)*)  +\S)");
  std::vector<std::string> names;
  for (std::sregex_iterator match(source.begin(), source.end(), line), end; match != end; ++match)
    names.push_back((*match)[1]);
  return names;
}

SpecTable stream_table(const std::string& heading) { return spec_tables(heading).at(1); }

TEST(SpecTables, StateTheStreamsInTheirOrder) {
  const std::vector<std::string> distance = coded_streams("octree/page/page_streams.h");
  const std::vector<std::string> mask = coded_streams("octree/page/mask_streams.h");
  EXPECT_EQ(distance.size(), 22u);
  EXPECT_EQ(mask.size(), 22u);
  EXPECT_EQ(stream_table("Distance page").column("stream"), distance);
  EXPECT_EQ(stream_table("Mask page").column("stream"), mask);
}

class SpecStreams : public testing::TestWithParam<const char*> {};
INSTANTIATE_TEST_SUITE_P(All, SpecStreams, testing::Values("Distance page", "Mask page"),
                         [](const auto& each) {
                           return std::string(each.param).substr(0, std::strlen(each.param) - 5);
                         });

TEST_P(SpecStreams, AreSplitWhereWiderThanAByte) {
  const SpecTable table = stream_table(GetParam());
  const std::vector<std::string> elements = table.column("element");
  const std::vector<std::string> split = table.column("split");
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const bool is_wide = elements[i] != "u8" && elements[i] != "i8" && elements[i] != "bits";
    EXPECT_EQ(split[i], is_wide ? "yes" : "") << table.rows[i].front();
  }
}

TEST(SpecTables, StateTheAttributesAndTheirBytes) {
  const SpecTable kinds = spec_tables("Attributes").at(0);
  const std::vector<TableRow> streams = stream_table("Attribute page").rows;
  ASSERT_EQ(kinds.rows.size(), 4u);
  ASSERT_EQ(streams.size(), 5u);  // links have two
  EXPECT_EQ(streams[0].back(), "bit 0");
  for (std::size_t i = 0; i < kinds.rows.size(); ++i) {
    const std::string bit = std::to_string(i);
    storage::ModelRecord model{};
    model.attributes = static_cast<std::uint8_t>(1u << i);
    EXPECT_EQ(kinds.rows[i].at(0), bit);
    EXPECT_EQ(std::stoul(kinds.rows[i].at(2)), model.attribute_bytes()) << i;
    EXPECT_EQ(streams[i + 1].back(), "bit " + bit);
  }
  EXPECT_EQ(kAllAttributes, 15u);
}

TEST(SpecTables, StateTheOctcodesOfCells) {
  const SpecTable table = spec_tables("Octcode").at(0);
  EXPECT_GE(table.rows.size(), 5u);
  for (const TableRow& row : table.rows) {
    const auto number = [&](std::size_t cell) {
      return static_cast<std::uint32_t>(std::stoul(row.at(cell)));
    };
    const std::uint64_t morton = octree::morton_code(number(0), number(1), number(2));
    EXPECT_EQ(std::stoull(row.at(4), nullptr, 16), octree::octcode_of_prefix(morton, number(3)));
  }
}

}  // namespace
}  // namespace planetree::golden
