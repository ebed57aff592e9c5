#include "tools/points/column_words.h"

#include <algorithm>
#include <array>

namespace planetree::tools {
namespace {

constexpr std::string_view kPositions[] = {
    "coord",    "coordinate", "coordinates", "coords", "koordinate", "loc",
    "local",    "location",   "node",        "pnt",    "point",      "points",
    "pos",      "position",   "positions",   "pt",     "vert",       "vertex",
    "vertices", "world",      "global",      "xyz",    "cartesian"};
constexpr std::string_view kUnits[] = {"m",    "mm",    "cm",    "dm",     "km",
                                       "um",   "nm",    "in",    "ft",     "inch",
                                       "feet", "meter", "metre", "meters", "metres"};
// The names of x, y and z in surveys.
constexpr std::array<std::array<std::string_view, 8>, 3> kSurvey = {
    {{"e", "east", "easting", "eastings", "rechtswert"},
     {"n", "north", "northing", "northings", "hochwert"},
     {"h", "height", "z", "up", "elevation", "elev", "altitude", "alt"}}};

template <class Words>
bool contains(const Words& words, std::string_view word) {
  return !word.empty() && std::find(std::begin(words), std::end(words), word) != std::end(words);
}

constexpr bool is_upper(char c) { return c >= 'A' && c <= 'Z'; }
constexpr bool is_lower(char c) { return c >= 'a' && c <= 'z'; }
// Bytes of letters beyond ASCII are letters, so that a name with one is a word of its own.
constexpr bool is_alphanumeric(char c) {
  return is_upper(c) || is_lower(c) || (c >= '0' && c <= '9') || static_cast<signed char>(c) < 0;
}

/// "pos", "x" of "posx", and of "xpos".
std::vector<std::string> split_axis(const std::string& word) {
  constexpr std::string_view kLetters = "xyz";
  if (word.size() < 3) return {word};
  const std::string front = word.substr(0, 1), back = word.substr(word.size() - 1);
  if (kLetters.find(back) != std::string_view::npos &&
      contains(kPositions, std::string_view(word).substr(0, word.size() - 1)))
    return {word.substr(0, word.size() - 1), back};
  if (kLetters.find(front) != std::string_view::npos &&
      contains(kPositions, std::string_view(word).substr(1)))
    return {front, word.substr(1)};
  return {word};
}

/// The axis of one word. Digits are 0 to 2.
std::optional<std::size_t> axis_of(const std::string& word, std::string_view letters) {
  if (word.size() != 1) return std::nullopt;
  const std::size_t axis = letters.find(word[0]);
  if (axis == std::string_view::npos) return std::nullopt;
  return axis;
}

/// The axis in words of which all others are for a position. `least` is how many others there are
/// at least.
std::optional<AxisName> axis_among(const std::vector<std::string>& words, std::string_view letters,
                                   std::size_t least) {
  AxisName name;
  std::size_t found = 0;
  std::optional<std::size_t> same;
  for (const std::string& word : words) {
    const auto also = survey_name({word});
    if (const auto axis = axis_of(word, letters)) {
      name.axis = *axis;
      ++found;
    } else if (contains(kPositions, word)) {
      name.family += word + ' ';
    } else if (!also || word.size() == 1 || (same && same != also->axis)) {
      return std::nullopt;
    } else {
      same = also->axis;  // "X/Easting"
    }
  }
  if (same && same != name.axis) return std::nullopt;
  if (found != 1 || words.size() < least + 1) return std::nullopt;
  return name;
}

}  // namespace

std::string lower_case(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (is_upper(c)) c = static_cast<char>(c | 0x20);
  return lower;
}

std::string upper_case(std::string_view text) {
  std::string upper(text);
  for (char& c : upper)
    if (is_lower(c)) c = static_cast<char>(c & ~0x20);
  return upper;
}

std::string without_brackets(std::string_view name) {
  constexpr std::string_view kOpening = "[({<", kClosing = "])}>";
  std::string text;
  std::size_t depth = 0;
  for (const char c : name) {
    if (kOpening.find(c) != std::string_view::npos)
      ++depth;
    else if (kClosing.find(c) != std::string_view::npos)
      depth -= depth > 0 ? 1 : 0;
    else if (depth == 0)
      text += c;
  }
  const std::size_t begin = std::min(text.find_first_not_of(' '), text.size());
  const std::size_t end = text.find_last_not_of(' ') + 1;
  return begin < end ? text.substr(begin, end - begin) : std::string();
}

std::vector<std::string> words_of(std::string_view name) {
  const std::string text = without_brackets(name);
  std::vector<std::string> words;
  char before = ' ';
  for (const char c : text) {
    if (is_alphanumeric(c)) {
      const bool begins = !is_alphanumeric(before) || (is_lower(before) && is_upper(c));
      if (begins) words.emplace_back();
      words.back() += c;
    }
    before = c;
  }
  for (std::string& word : words) word = lower_case(word);
  if (words.size() > 1 && contains(kUnits, words.back())) words.pop_back();
  return words;
}

std::optional<AxisName> axis_name(const std::vector<std::string>& words) {
  std::vector<std::string> split;
  for (const std::string& word : words)
    for (std::string& part : split_axis(word)) split.push_back(std::move(part));
  if (auto name = axis_among(split, "xyz", 0)) return name;
  auto name = axis_among(split, "012", 1);
  if (name) name->family += "by number";
  return name;
}

std::optional<AxisName> survey_name(const std::vector<std::string>& words) {
  if (words.size() != 1) return std::nullopt;
  for (std::size_t axis = 0; axis < kSurvey.size(); ++axis)
    if (contains(kSurvey[axis], words[0])) return AxisName{axis, "survey"};
  return std::nullopt;
}

}  // namespace planetree::tools
