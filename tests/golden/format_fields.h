#pragma once

#include <cstddef>
#include <string>
#include <vector>

/// The fields of the structs that are bytes of a file, as the code has them:
/// what the tables of the specification are held against.
namespace planetree::golden {

struct FormatField {
  std::string name;
  std::size_t offset;
  std::size_t size;
  std::string encoding;  ///< as the specification writes it: "u32", "f64 x 3", "record"

  friend bool operator==(const FormatField&, const FormatField&) = default;
};

/// All fields of one struct, by offset.
struct FormatStruct {
  std::string heading;  ///< of the specification's section with its table
  std::size_t size;
  std::vector<FormatField> fields;
};

/// storage::FileHeader, ModelRecord, PageEntry and octree::PageHead.
const std::vector<FormatStruct>& format_structs();

/// The struct of that heading.
const FormatStruct& format_struct(const std::string& heading);

/// The specification's name of what the code calls `name`: a field or a stream.
std::string spec_name(const std::string& name);

}  // namespace planetree::golden
