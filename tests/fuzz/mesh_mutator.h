#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "tests/fuzz/mutation.h"

namespace planetree {

/// What a mutator knows of a mesh format.
struct MeshGrammar {
  /// Words with a meaning, and numbers in the spellings of the format.
  std::span<const std::string_view> words;
  /// The number of bytes at the front that are lines of text; the others are binary.
  std::size_t (*text_bytes)(std::string_view mesh);
  /// Makes counts and lengths agree with each other again.
  void (*repair)(std::string& mesh, Choices& choices);
};

extern const MeshGrammar kPlyGrammar, kOffGrammar, kObjGrammar, kStlGrammar, kGltfGrammar;

/// Changes words, numbers and lines of a mesh, so that most results still have a valid header.
/// One input in three is left to libFuzzer's own changes. The arguments are those of
/// LLVMFuzzerCustomMutator.
std::size_t mutate_mesh(const MeshGrammar& grammar, std::uint8_t* data, std::size_t size,
                        std::size_t max_size, unsigned seed);

}  // namespace planetree
