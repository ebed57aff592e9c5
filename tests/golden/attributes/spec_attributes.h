#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/golden/spec_reader.h"

/// "Attributes". Part of the independent reader: see spec_reader.h.
namespace planetree::golden {

/// Link of an index that no block has.
inline constexpr SpecLink kNoBlock = spec_link(true, 0xffffffff, 0xffff);

using SpecColour = std::array<std::uint8_t, 4>;  ///< red, green, blue and alpha
using SpecUv = std::array<float, 2>;             ///< texture coordinates u and v
using SpecColours = std::array<SpecColour, 3>;   ///< of the corners
using SpecUvs = std::array<SpecUv, 3>;           ///< of the corners

/// Attributes in the order of indices. A list is empty if the file does not have that attribute.
struct SpecAttributeLists {
  std::vector<SpecLink> links;
  std::vector<SpecColours> colours;
  std::vector<SpecUvs> uvs;
  std::vector<std::uint64_t> values;  ///< bits, whatever the type is
};

/// Decodes the raw bytes of page `number`, an attribute page ("Attribute page").
SpecAttributeLists decode_attribute_page(std::span<const std::byte> raw, std::uint32_t number,
                                         const SpecHeader& header);

/// The attributes of a file, from all its attribute pages. A call throws if the file does not have
/// the attribute, or if the index is not one of the input.
class SpecAttributes {
 public:
  explicit SpecAttributes(const SpecFile& file);

  /// Number of indices that have attributes.
  std::uint64_t size() const { return lists_.links.size(); }
  SpecLink link(std::uint64_t index) const { return lists_.links.at(index); }
  const SpecColours& colours(std::uint64_t index) const { return lists_.colours.at(index); }
  const SpecUvs& uvs(std::uint64_t index) const { return lists_.uvs.at(index); }
  /// The bits of a value. `value_kind` of the header tells their type.
  std::uint64_t value(std::uint64_t index) const { return lists_.values.at(index); }

 private:
  SpecAttributeLists lists_;
};

}  // namespace planetree::golden
