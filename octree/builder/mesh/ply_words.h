#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "octree/builder/mesh/ply_header.h"
#include "octree/builder/mesh/stream/mesh_file.h"
#include "octree/builder/mesh/stream/mesh_lines.h"
#include "octree/builder/mesh/stream/mesh_note.h"
#include "octree/builder/mesh/stream/mesh_text.h"
#include "planetree/error.h"

namespace planetree::octree {

/// How the records of an ascii body are laid out in lines.
struct PlyLayout {
  /// Each record begins a line, and what follows it on the line is no record.
  bool is_loose = false;
  /// Lines end wherever they happen to. So they tell nothing of where records end.
  bool is_stream = false;
  bool has_hashes = false;  ///< '#' begins a comment; otherwise lines "comment" and "obj_info" do
  std::size_t window_bytes = MeshWindow::kWindowBytes;
};

/// The words of an ascii body, record by record. Records may share lines or go over lines. But a
/// number that is missing or one too many must not move all that follow: where records have kept to
/// lines, one that ends or begins elsewhere is refused.
///
/// Steps return false at an error; see error().
class PlyWords {
 public:
  /// Where reading can go on: in front of a word, within a record or between two.
  struct State {
    TextPosition next;            ///< of the next word
    TextPosition begin;           ///< of the record
    std::string first_word;       ///< of the record, if it began within a line
    std::uint64_t crossed = 0;    ///< the first line on which the record ends nowhere, or 0
    std::string missing;          ///< the property that the line lacks
    bool is_within_line = false;  ///< `next` is behind other words of its line
  };

  /// file, layout  must outlive this.
  PlyWords(const MeshFile& file, const TextPosition& begin, PlyLayout& layout);
  PlyWords(const MeshFile& file, State state, PlyLayout& layout);
  /// Counts coordinates that are declared as floats and have digits that no float holds.
  void note_rounded(MeshNote& note) { rounded_ = &note; }

  /// Steps to the next record. False at the end of the text too, without an error.
  bool begin_record();
  /// Position of the record.
  [[nodiscard]] const TextPosition& begin() const { return state_.begin; }
  /// Reads the next value of the record, as a property says.
  bool integer(const PlyProperty& property, std::int64_t& value);
  /// Reads the length of a list, which the items follow.
  bool length(const PlyProperty& property, std::int64_t& value);
  /// Reads a number in the precision that the header declares, whatever digits the text has.
  bool real(const PlyProperty& property, double& value);
  /// As real(), without counting digits.
  bool number(const PlyProperty& property, double& value);
  /// Reads a value as TriangleAttributes has it. An integer must fit in 64 bits, with or without
  /// sign as the property is.
  bool value(const PlyProperty& property, std::uint64_t& value);
  /// Passes over a value or a list.
  bool pass(const PlyProperty& property);
  /// Passes over the properties of a record from `first` up to `end`.
  bool pass(const PlyElement& element, std::size_t first, std::size_t end);
  /// Ends the record.
  bool end_record() {
    ++records_on_line_;
    return state_.crossed == 0 || check_crossing();
  }
  /// Whether the record went on in a further line.
  [[nodiscard]] bool has_crossed() const { return state_.crossed > 0; }
  /// Takes the next word on the line, if it is an integer. False, without an error, if not.
  bool integer_on_line(std::int64_t& value);
  /// Number of words behind the record on its line, which are passed over.
  std::uint64_t words_left_on_line();

  /// Position behind the last word, or of the next line if there is no further word on this one.
  TextPosition after();
  [[nodiscard]] State state();
  [[nodiscard]] std::uint64_t line() const { return lines_.position().line; }
  /// Bytes of the file up to the end of the current line.
  [[nodiscard]] std::uint64_t bytes_done() const { return lines_.after().offset; }

  /// The error of the last step; none where the text ends between records.
  [[nodiscard]] const std::optional<Error>& error() const { return error_; }
  /// An error at the line of the record.
  [[nodiscard]] Error error_here(const std::string& cause) const;
  [[nodiscard]] Error error_at(const TextPosition& position, const std::string& cause) const;
  /// The error of a text that ends, or cannot be read, in front of a record.
  [[nodiscard]] Error ended(const PlyElement& element, std::uint64_t record);
  /// The error of a record that begins within a line and must not.
  [[nodiscard]] Error surplus_error() const {
    return error_here("'" + state_.first_word + "' follows the last declared value");
  }
  /// The error of a record that goes on in a further line and must not.
  [[nodiscard]] Error crossing_error() const;

  /// Removes the limit on the length of a record in the text.
  void allow_long_records() { max_record_bytes_ = ~std::uint64_t{0}; }

 private:
  /// The next word of the record; empty if there is none.
  std::string_view word(const PlyProperty& property) {
    const std::string_view word = take_word(rest_);
    return word.empty() ? word_of_next_line(property) : word;
  }
  std::string_view word_of_next_line(const PlyProperty& property);
  bool next_line();
  bool has_word_on_line();
  bool begin_within_line();
  /// Whether the record is in a stream of words: behind several records on its line.
  [[nodiscard]] bool is_of_stream() const {
    constexpr std::uint64_t kRecords = 2;
    return layout_.is_stream || state_.begin.records >= kRecords;
  }
  bool check_crossing();
  bool fail(const Error& error);
  bool no_number(const PlyProperty& property, std::string_view word, const char* what);
  [[nodiscard]] TextPosition position() const;

  PlyLayout& layout_;
  MeshLines lines_;
  std::string_view rest_;  ///< of the current line
  std::uint64_t records_on_line_ = 0;
  std::uint64_t max_record_bytes_ = MeshLines::kMaxLineBytes;
  State state_;
  MeshNote* rounded_ = nullptr;
  std::optional<Error> error_;
};

}  // namespace planetree::octree
