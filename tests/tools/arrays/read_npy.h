#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <regex>
#include <string>
#include <vector>

/// Reads structured NumPy arrays for tests, from the description of the format alone.
namespace planetree::tools {

struct ReadNpy {
  std::size_t header_bytes = 0;
  std::size_t rows = 0;
  std::vector<std::pair<std::string, std::string>> fields;  ///< names and types, in order
  std::map<std::string, std::vector<double>> columns;

  [[nodiscard]] std::string names() const {
    std::string text;
    for (const auto& [name, type] : fields) text += (text.empty() ? "" : ",") + name;
    return text;
  }
  [[nodiscard]] std::string type_of(const std::string& wanted) const {
    for (const auto& [name, type] : fields)
      if (name == wanted) return type;
    return "none";
  }
};

template <class Number>
double number_at(const std::string& bytes, std::size_t at) {
  Number number;
  std::memcpy(&number, bytes.data() + at, sizeof number);
  return static_cast<double>(number);
}

inline ReadNpy read_npy(const std::string& bytes) {
  ReadNpy array;
  if (bytes.size() < 10 || bytes.compare(0, 6, "\x93NUMPY") != 0 || bytes[6] != 1 ||
      bytes[7] != 0) {
    ADD_FAILURE() << "no NumPy array of version 1.0";
    return array;
  }
  array.header_bytes = 10 + static_cast<std::size_t>(number_at<std::uint16_t>(bytes, 8));
  const std::string header = bytes.substr(10, array.header_bytes - 10);
  std::smatch found;
  const std::regex whole(R"(\{'descr': \[((?:\('\w+', '[<|]\w+'\), )+)\], 'fortran_order': False, )"
                         R"('shape': \((\d+),\), \} *\n)");
  if (!std::regex_match(header, found, whole)) {
    ADD_FAILURE() << header;
    return array;
  }
  array.rows = std::stoul(found[2]);
  const std::string fields = found[1];
  const std::regex field(R"(\('(\w+)', '([<|]\w+)'\))");
  for (std::sregex_iterator i(fields.begin(), fields.end(), field), end; i != end; ++i)
    array.fields.emplace_back((*i)[1], (*i)[2]);
  std::size_t at = array.header_bytes;
  for (std::size_t row = 0; row < array.rows; ++row)
    for (const auto& [name, type] : array.fields) {
      const std::size_t size = type.back() == '8' ? 8 : 1;
      if (at + size > bytes.size()) {
        ADD_FAILURE() << "the array ends in row " << row;
        return array;
      }
      array.columns[name].push_back(type == "<f8"   ? number_at<double>(bytes, at)
                                    : type == "<i8" ? number_at<std::int64_t>(bytes, at)
                                                    : number_at<std::uint8_t>(bytes, at));
      at += size;
    }
  EXPECT_EQ(at, bytes.size());
  return array;
}

}  // namespace planetree::tools
