#pragma once

#include <cstdint>
#include <string_view>

namespace planetree::tools {

/// What separates the fields of a line. kBlank is any number of blanks and tabs. Around the others
/// blanks have no meaning.
enum class Separator : std::uint8_t { kSemicolon, kTab, kComma, kBlank };
inline constexpr Separator kSeparators[] = {Separator::kSemicolon, Separator::kTab,
                                            Separator::kComma, Separator::kBlank};

/// "semicolon", "tab", "comma" or "blank".
[[nodiscard]] const char* separator_word(Separator separator);

/// The text without blanks and tabs at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text);

/// Steps through the fields of a line. A field in double quotes is without them, and may contain
/// the separator. One with an opening quote alone lasts to the end of the line.
class LineFields {
 public:
  LineFields(std::string_view line, Separator separator);

  /// Steps to the next field. False at the end of the line.
  bool next();
  [[nodiscard]] std::string_view field() const { return field_; }

 private:
  [[nodiscard]] const char* find_separator(const char* from) const;

  std::string_view rest_;
  char separator_;
  char other_separator_;  // a tab besides a blank, otherwise the same
  bool ended_ = false;
  std::string_view field_;
};

}  // namespace planetree::tools
