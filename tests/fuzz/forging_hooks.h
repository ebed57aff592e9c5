#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <utility>

#include "tests/fuzz/file_mutator.h"

/// What libFuzzer calls to make an input of one or two others, in the fuzzers of whole files. One
/// source of a program includes this.
namespace planetree {

/// Copies bytes to libFuzzer's buffer. Returns 0 if they do not fit: the input is left out.
inline std::size_t give(std::span<const std::byte> bytes, std::uint8_t* data,
                        std::size_t max_size) {
  if (bytes.size() > max_size) return 0;
  std::memcpy(data, bytes.data(), bytes.size());
  return bytes.size();
}

inline std::span<const std::byte> bytes_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const std::byte*>(data), size};
}

}  // namespace planetree

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size,
                                               std::size_t max_size, unsigned seed) {
  using namespace planetree;
  auto file = storage::ForgedFile::of(bytes_of(data, size));
  if (!file || seed % 64 == 0) return LLVMFuzzerMutate(data, size, max_size);
  return give(storage::FileMutator(seed).mutate(*std::move(file)), data, max_size);
}

extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* data, std::size_t size,
                                                 const std::uint8_t* other, std::size_t other_size,
                                                 std::uint8_t* out, std::size_t max_size,
                                                 unsigned seed) {
  using namespace planetree;
  auto file = storage::ForgedFile::of(bytes_of(data, size));
  const auto from = storage::ForgedFile::of(bytes_of(other, other_size));
  if (!file || !from) return 0;
  return give(storage::FileMutator(seed).cross(*std::move(file), *from), out, max_size);
}
