#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <regex>
#include <string>
#include <vector>

/// Reads VTK files of PolyData with raw appended arrays for tests, from the description of the
/// format alone.
namespace planetree::tools {

struct ReadVtpArray {
  std::string type;
  std::size_t components = 1;
  std::vector<double> values;
};

struct ReadVtp {
  std::size_t points = 0, verts = 0, polys = 0;
  std::string scalars;                         ///< name of the array shown first
  std::map<std::string, ReadVtpArray> arrays;  ///< "Points", "PointData/side", "Verts/offsets"

  [[nodiscard]] const std::vector<double>& values(const std::string& name) const {
    static const std::vector<double> none;
    const auto found = arrays.find(name);
    EXPECT_NE(found, arrays.end()) << name;
    return found == arrays.end() ? none : found->second.values;
  }
};

/// The value of an attribute of an element, empty if it has none.
inline std::string attribute_of(const std::string& element, const std::string& name) {
  std::smatch found;
  return std::regex_search(element, found, std::regex(" " + name + "=\"([^\"]*)\""))
             ? found[1].str()
             : "";
}

template <class Number>
std::vector<double> appended_numbers(const std::string& data, std::size_t at) {
  std::uint64_t bytes = 0;
  if (at + sizeof bytes > data.size()) return {};
  std::memcpy(&bytes, data.data() + at, sizeof bytes);
  EXPECT_EQ(bytes % sizeof(Number), 0u);
  std::vector<double> values;
  for (std::size_t i = at + sizeof bytes;
       i + sizeof(Number) <= at + sizeof bytes + bytes && i + sizeof(Number) <= data.size();
       i += sizeof(Number)) {
    Number number;
    std::memcpy(&number, data.data() + i, sizeof number);
    values.push_back(static_cast<double>(number));
  }
  EXPECT_EQ(values.size() * sizeof(Number), bytes);
  return values;
}

inline ReadVtp read_vtp(const std::string& file) {
  ReadVtp read;
  const std::string begin = "<AppendedData encoding=\"raw\">\n   _";
  const std::string end = "\n  </AppendedData>\n</VTKFile>\n";
  const std::size_t data_at = file.find(begin);
  if (data_at == std::string::npos || !file.ends_with(end)) {
    ADD_FAILURE() << "no VTK file with appended data";
    return read;
  }
  const std::string xml = file.substr(0, data_at);
  std::string data = file.substr(data_at + begin.size());
  data.resize(data.size() - end.size());
  EXPECT_EQ(attribute_of(xml, "type"), "PolyData");
  EXPECT_EQ(attribute_of(xml, "byte_order"), "LittleEndian");
  EXPECT_EQ(attribute_of(xml, "header_type"), "UInt64");
  const auto count = [&xml](const char* name) { return std::stoul(attribute_of(xml, name)); };
  read.points = count("NumberOfPoints");
  read.verts = count("NumberOfVerts");
  read.polys = count("NumberOfPolys");
  read.scalars = attribute_of(xml, "Scalars");
  std::string parent;
  std::size_t described = 0;  // bytes of the arrays
  const std::regex element("<(/?\\w+)([^>]*)>");
  for (std::sregex_iterator i(xml.begin(), xml.end(), element), none; i != none; ++i) {
    const std::string name = (*i)[1], attributes = (*i)[2];
    if (name != "DataArray") {
      if (name[0] != '/') parent = name;
      continue;
    }
    ReadVtpArray array;
    array.type = attribute_of(attributes, "type");
    const std::string components = attribute_of(attributes, "NumberOfComponents");
    if (!components.empty()) array.components = std::stoul(components);
    const std::size_t at = std::stoul(attribute_of(attributes, "offset"));
    EXPECT_EQ(at, described) << "arrays without gaps";
    array.values = array.type == "Float64" ? appended_numbers<double>(data, at)
                   : array.type == "Int64" ? appended_numbers<std::int64_t>(data, at)
                                           : appended_numbers<std::uint8_t>(data, at);
    described += 8 + array.values.size() * (array.type == "UInt8" ? 1 : 8);
    const std::string own = attribute_of(attributes, "Name");
    read.arrays[parent == "Points" ? own : parent + '/' + own] = array;
  }
  EXPECT_EQ(described, data.size());
  return read;
}

}  // namespace planetree::tools
