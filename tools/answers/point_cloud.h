#pragma once

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "planetree/error.h"
#include "planetree/types.h"
#include "tools/answers/answer_output.h"

namespace planetree::tools {

/// Points that become the vertices of a binary PLY file. Its header needs their number, so that
/// they are kept in a temporary file without a name until all are known.
class PointCloud {
 public:
  /// value   name of the number that each point has
  /// errors  as storage::file_error()
  static Result<PointCloud> create(const std::string& value, bool has_normals);

  /// errors  as storage::file_error()
  Result<void> add(const Vec3& point, const Vec3& normal, double value);
  /// Writes the file. The last call. False and errors as AnswerOutput::write(), and as
  /// storage::file_error().
  Result<bool> write_to(AnswerOutput& output);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  PointCloud(std::FILE* file, const std::string& value, bool has_normals)
      : file_(file), value_(value), has_normals_(has_normals) {}

  std::unique_ptr<std::FILE, Close> file_;
  std::string value_;
  bool has_normals_;
  std::uint64_t count_ = 0;
};

}  // namespace planetree::tools
