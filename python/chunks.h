#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>

#include <pybind11/pybind11.h>

namespace planetree::python {

/// Maximum memory of the answers of a chunk, in bytes.
inline constexpr std::size_t kMaxChunkBytes = std::size_t{48} << 20;

/// Number of answers that a chunk of in_chunks() has at most, at least 1 if there are any.
inline std::size_t max_chunk_rows(std::size_t count, std::size_t row_bytes) {
  return std::min(count, std::max<std::size_t>(1, kMaxChunkBytes / row_bytes));
}

/// Runs a long call chunk by chunk, without Python's global lock. Between chunks, signals such as
/// Ctrl-C are handled and progress is told, which may raise an exception. Chunks grow while they
/// take less than kSoon, so that Ctrl-C need not wait long.
///
/// row_bytes  memory of the answers of one row
/// progress   called as progress(done, count); or None
/// query      query(first, end) answers some rows; does not throw
template <class Query>
void in_chunks(std::size_t count, std::size_t row_bytes, const pybind11::object& progress,
               const Query& query) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kSoon(100);
  constexpr std::size_t kFirstRows = 65536, kGrowth = 4;
  const std::size_t max_rows = max_chunk_rows(count, row_bytes);
  std::size_t rows = std::min(kFirstRows, max_rows);
  for (std::size_t done = 0; done < count;) {
    const std::size_t end = done + std::min(rows, count - done);
    const Clock::time_point start = Clock::now();
    {
      const pybind11::gil_scoped_release unlocked;
      query(done, end);
    }
    if (Clock::now() - start < kSoon) rows = std::min(rows * kGrowth, max_rows);
    done = end;
    if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
    if (!progress.is_none()) progress(done, count);
  }
}

}  // namespace planetree::python
