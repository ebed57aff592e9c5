#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// The fields of the structs that are stored in a file, taken from the code. Tests compare the
/// tables of the specification with them.
namespace planetree::golden {

struct FormatField {
  std::string name;
  std::size_t offset;
  std::size_t size;
  std::string encoding;  ///< in the specification's notation: "u32", "f64 x 3", "record"

  friend bool operator==(const FormatField&, const FormatField&) = default;
};

/// All fields of one struct, ordered by offset.
struct FormatStruct {
  std::string heading;  ///< heading of the specification's section with the table
  std::size_t size;
  std::vector<FormatField> fields;
  std::size_t table = 0;  ///< rank of the table among those of fields in its section
};

/// Fields of the header, the model record, unbalanced edges, entries of the directory, extension
/// records, and the heads of pages.
const std::vector<FormatStruct>& format_structs();

/// The first struct with the given heading.
const FormatStruct& format_struct(const std::string& heading);

}  // namespace planetree::golden
