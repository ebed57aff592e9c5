#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "planetree/error.h"

namespace planetree::tools {

/// Kinds of issues of a .ptree file, as defined in format-spec/ISSUES.md. Released names are
/// stable.
enum class IssueCode : std::uint8_t {
  kNotPlanetree,
  kFormatUnsupported,
  kFileLength,
  kHeaderLost,
  kHeaderCopy,
  kHeaderField,
  kDirectory,
  kPageEntry,
  kPageRead,
  kPageChecksum,
  kPageCodec,
  kPageStructure,
  kLinkTarget,
  kLinkTwice,
  kSubtreeUnlinked,
  kSubtreeBox,
  kRootBox,
  kHeight,
  kCount,
  kTriangleRange,
  kTriangleTwice,
  kVertexOutsideBox,
  kVertexOutsidePlanes,
  kMoments,
  kModelBox,
  kSample,
  kUnbalancedEdges,
  kOpenness,
  kMaskCorner,
  kMaskColour,
  kMaskPlanes,
  kMaskBlocks,
  kMaskSlab,
  kBlockHeightField,
  kRegion,
  kCaps,
  kField,
  kAttributes,
  kExtension,
  kSet,
};
inline constexpr std::size_t kIssueCodeCount = static_cast<std::size_t>(IssueCode::kSet) + 1;

/// The code's name in reports, such as "PAGE_CHECKSUM".
[[nodiscard]] std::string_view issue_name(IssueCode code);

/// One issue of a file.
struct Issue {
  IssueCode code = IssueCode::kNotPlanetree;
  std::uint64_t page = Error::kNowhere;    ///< page number, or kNowhere
  std::uint64_t offset = Error::kNowhere;  ///< byte offset in the file, or kNowhere
  std::string message;                     ///< one line

  /// An issue with the page, offset and text of an error.
  static Issue from(IssueCode code, const Error& error);
};

/// {code, page, message} and, if known, offset. `page` is null if the issue has none.
[[nodiscard]] nlohmann::ordered_json issue_json(const Issue& issue);

/// "PAGE_CHECKSUM: page 3, at byte 4096: message".
[[nodiscard]] std::string issue_text(const Issue& issue);

}  // namespace planetree::tools
