#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "planetree/error.h"
#include "storage/file/checksum.h"
#include "storage/system/byte_source.h"

/// A set file: which files have the bytes of a model. format-spec/set-v1/spec.md specifies
/// its text.
namespace planetree::storage {

/// A box in the coordinates of the input.
struct MemberBox {
  double lower[3];
  double upper[3];
};

/// A file that has a part of the model's bytes.
struct SetMember {
  std::string address;      ///< path or URL; if relative, from where the set file is
  std::uint64_t bytes = 0;  ///< length, at least 1
  Hash128 hash{};           ///< XXH3-128 of all its bytes
  std::uint32_t pages = 0;  ///< number of pages in it, of all kinds
  /// Contains the triangles of its pages; empty if it has no page of triangles.
  std::optional<MemberBox> box{};
};

/// Members in the order of their bytes. Joined, they are a .ptree file.
struct SetDescription {
  static constexpr std::size_t kMaxMembers = 256;
  static constexpr std::size_t kMaxBytes = std::size_t{1} << 20;  ///< of the text
  /// How the name of a set ends.
  static constexpr std::string_view kExtension = ".ptreeset";

  Hash128 content_id{};  ///< that of the header
  std::vector<SetMember> members;

  /// Sum of the members' lengths.
  std::uint64_t bytes() const noexcept;
  /// The set file as a text.
  std::string text() const;
  /// Reads a text, of which nothing is trusted.
  ///
  /// errors  kNotPlanetree: it is no set file; kUnsupported: it has another version; kDamaged: a
  ///         value is missing or not allowed
  static Result<SetDescription> parse(std::span<const std::byte> text);
  /// Reads a file with a text.
  ///
  /// errors  those of reading and of parse()
  static Result<SetDescription> read(const ByteSource& file);
};

}  // namespace planetree::storage
