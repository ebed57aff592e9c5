#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "planetree/error.h"

namespace planetree::tools {

/// What can be wrong with a .ptree file. format-spec/ISSUES.md says what each
/// means; names are stable once released.
enum class IssueCode : std::uint8_t {
  kNotPlanetree,
  kFormatUnsupported,
  kFileLength,
  kHeaderLost,
  kHeaderCopy,
  kHeaderField,
  kTable,
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
  kOpenEdges,
  kMaskCorner,
  kMaskColour,
  kMaskPlanes,
  kMaskBlocks,
  kMaskSlab,
  kBlockHeightField,
  kRegion,
};
inline constexpr std::size_t kIssueCodeCount = static_cast<std::size_t>(IssueCode::kRegion) + 1;

/// Such as "PAGE_CHECKSUM".
[[nodiscard]] std::string_view issue_name(IssueCode code);

/// One thing that is wrong.
struct Issue {
  IssueCode code = IssueCode::kNotPlanetree;
  std::uint64_t page = Error::kNowhere;    ///< or kNowhere
  std::uint64_t offset = Error::kNowhere;  ///< byte in the file, or kNowhere
  std::string message;                     ///< one line

  static Issue from(IssueCode code, const Error& error);
};

/// {code, page, message} and, where known, offset; page null if none.
[[nodiscard]] nlohmann::ordered_json issue_json(const Issue& issue);

/// "PAGE_CHECKSUM: page 3, at byte 4096: message".
[[nodiscard]] std::string issue_text(const Issue& issue);

}  // namespace planetree::tools
