#include "tools/picture/stroke_font.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string>

namespace planetree::tools {
namespace {

constexpr int kBaseLine = 3, kCapital = 9;  // rows of the base line, and from there to the top
constexpr int kGap = 3;                     // between glyphs
constexpr int kBlank = 4;                   // width of a blank
constexpr const char* kUnknown = "030c5c5303";

// From '!' to '~'. Two hexadecimal digits are a place: column from the left, and row from below. A
// blank ends a line.
constexpr std::array<const char*, 94> kGlyphs = {
    "0c06 0304",                         // !
    "0c0a 2c2a",                         // "
    "132c 435c 0969 0666",               // #
    "5b4c1c0b0918475654431304 3d32",     // $
    "036c 0c2c2a0a0c 4565634345",        // %
    "631a1b2c3c4b4a0605233367",          // &
    "0c0a",                              // '
    "2d0a0522",                          // (
    "0d2a2502",                          // )
    "3c36 0b67 076b",                    // *
    "0767 343a",                         // +
    "1402",                              // ,
    "0747",                              // -
    "0304",                              // .
    "024c",                              // /
    "2c0a052333555a3c2c",                // 0
    "0a2c23 0343",                       // 1
    "0a2c3c5a590353",                    // 2
    "0b1c4c5b594818 485754431304",       // 3
    "434c0656",                          // 4
    "5c0c08395755331304",                // 5
    "4c2c0a0523335556382806",            // 6
    "0c5c13",                            // 7
    "18090b1c4c5b59481807041343545748",  // 8
    "1333555a3c2c0a09273759",            // 9
    "0304 0809",                         // :
    "1402 1819",                         // ;
    "4a0744",                            // <
    "0858 0656",                         // =
    "0a4704",                            // >
    "0a2c3c5a593735 3334",               // ?
    "48282646494655666a5c2c0a052353",    // @
    "033c63 1656",                       // A
    "030c4c5b594808 485867645303",       // B
    "6a4c2c0a05234365",                  // C
    "030c3c69663303",                    // D
    "5c0c0353 0848",                     // E
    "5c0c03 0848",                       // F
    "6a4c2c0a052343656737",              // G
    "030c 636c 0868",                    // H
    "030c",                              // I
    "4c45331305",                        // J
    "030c 5c06 2853",                    // K
    "0c0353",                            // L
    "030c468c83",                        // M
    "030c636c",                          // N
    "2c0a052343656a4c2c",                // O
    "030c4c5b584707",                    // P
    "2c0a052343656a4c2c 4663",           // Q
    "030c4c5b584707 3753",               // R
    "5b4c1c0b0918475654431304",          // S
    "0c6c 3c33",                         // T
    "0c052343656c",                      // U
    "0c336c",                            // V
    "0c234c638c",                        // W
    "0c63 036c",                         // X
    "0c386c 3833",                       // Y
    "0c6c0363",                          // Z
    "2d0d0222",                          // [
    "0c42",                              // backslash
    "0d2d2202",                          // ]
    "0a2c4a",                            // ^
    "0252",                              // _
    "0c1a",                              // `
    "5953 5739290705233355",             // a
    "0c03 0729395755332305",             // b
    "5849290705234354",                  // c
    "5c53 5739290705233355",             // d
    "06565739290705234354",              // e
    "4c3c2b23 0949",                     // f
    "5952301001 5739290705233355",       // g
    "0c03 0729395753",                   // h
    "0309 0b0c",                         // i
    "29211000 2b2c",                     // j
    "0c03 4905 2743",                    // k
    "0c0413",                            // l
    "0903 0729394843 4769798883",        // m
    "0903 0729395753",                   // n
    "290705233355573929",                // o
    "0900 0729395755332305",             // p
    "5950 5739290705233355",             // q
    "0903 072939",                       // r
    "483919080716364544331304",          // s
    "2c243343 0949",                     // t
    "0905233355 5953",                   // u
    "093369",                            // v
    "0923496389",                        // w
    "0953 0359",                         // x
    "0933 69331000",                     // y
    "09590353",                          // z
    "3d2d1c180716132232",                // {
    "0d01",                              // |
    "0d1d2c283726231202",                // }
    "06284668",                          // ~
};

int digit(char c) { return c <= '9' ? c - '0' : c - 'a' + 10; }

const char* glyph_of(unsigned char c) { return c > ' ' && c <= '~' ? kGlyphs[c - '!'] : kUnknown; }

// Bytes after the first of a character in UTF-8 have no glyph.
bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; }

int width_of(const char* glyph) {
  int width = 0;
  for (const char* at = glyph; *at != '\0'; at += 2) {
    if (*at == ' ') ++at;
    width = std::max(width, digit(*at));
  }
  return width;
}

int advance(char c) {
  return (c == ' ' ? kBlank : width_of(glyph_of(static_cast<unsigned char>(c)))) + kGap;
}

void add_glyph(const char* glyph, double x, double y, double unit, Stroke& stroke) {
  stroke.paths.emplace_back();
  for (const char* at = glyph; *at != '\0'; at += 2) {
    if (*at == ' ') {
      stroke.paths.emplace_back();
      ++at;
    }
    stroke.paths.back().push_back({x + digit(at[0]) * unit, y - (digit(at[1]) - kBaseLine) * unit});
  }
}

}  // namespace

double text_length(std::string_view text, double height) {
  int length = 0;
  for (const char c : text)
    if (!continues(c)) length += advance(c);
  return std::max(0, length - kGap) * height / kCapital;
}

Stroke text_stroke(const TextLine& line) {
  const double unit = line.height / kCapital;
  const double length = text_length(line.text, line.height);
  const double before = line.anchor == Anchor::kStart    ? 0
                        : line.anchor == Anchor::kMiddle ? std::floor(length / 2)
                                                         : length;
  // At the middles of pixels, where lines across and upright are sharp.
  double x = std::floor(line.at.x - before) + 0.5;
  const double y = std::floor(line.at.y) - 0.5;
  Stroke stroke;
  stroke.colour = line.colour;
  stroke.width = 1.25 * std::max(1.0, unit);
  for (const char c : line.text) {
    if (continues(c)) continue;
    if (c != ' ') add_glyph(glyph_of(static_cast<unsigned char>(c)), x, y, unit, stroke);
    x += advance(c) * unit;
  }
  return stroke;
}

std::string shortened(std::string_view text, double height, double length) {
  if (text_length(text, height) <= length) return std::string(text);
  constexpr std::string_view kDots = "...";
  for (std::size_t kept = text.size(); kept-- > 2;) {
    std::size_t first = kept / 2, rest = text.size() - (kept - kept / 2);
    while (first > 0 && continues(text[first])) --first;
    while (rest < text.size() && continues(text[rest])) ++rest;
    std::string shorter(text.substr(0, first));
    shorter += kDots;
    shorter += text.substr(rest);
    if (text_length(shorter, height) <= length) return shorter;
  }
  return std::string(kDots);
}

}  // namespace planetree::tools
