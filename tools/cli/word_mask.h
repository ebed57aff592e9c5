#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace planetree::tools {

/// A word of a list on the command line, and the bit that it stands for.
using WordBit = std::pair<const char*, std::uint32_t>;

/// Returns the bits of a list of words with commas between them, and blanks anywhere; 0 if it is no
/// list of these words.
inline std::uint32_t bits_of_words(const std::string& text, std::span<const WordBit> known) {
  if (text.empty() || text.back() == ',') return 0;
  std::uint32_t bits = 0;
  std::istringstream words(text);
  for (std::string word; std::getline(words, word, ',');) {
    word.erase(0, word.find_first_not_of(' '));
    word.erase(word.find_last_not_of(' ') + 1);
    const auto found =
        std::ranges::find_if(known, [&word](const WordBit& one) { return word == one.first; });
    if (found == known.end()) return 0;
    bits |= found->second;
  }
  return bits;
}

/// Returns the words of `bits`, in the order of `known`.
inline std::vector<std::string> words_of_bits(std::uint32_t bits, std::span<const WordBit> known) {
  std::vector<std::string> words;
  for (const auto& [word, bit] : known)
    if ((bits & bit) != 0) words.emplace_back(word);
  return words;
}

}  // namespace planetree::tools
