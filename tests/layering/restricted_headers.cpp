#include "tests/layering/layers.h"

// Libraries that only some files may include.
namespace planetree::layering {

const std::vector<RestrictedHeader>& restricted_headers() {
  static const std::vector<RestrictedHeader> all = {
      // The readers written from the specifications share no line with ours.
      {"lz4",
       {"storage/file/page_codec.cpp", "storage/spill/record_packing.cpp",
        "tests/golden/spec_reader.cpp", "tests/tools/trace_file/spec_trace_test.cpp"}},
      {"liburing",
       {"storage/system/file_calls.cpp", "storage/system/read_wait.h", "tests/storage/"}},
      {"xxh",
       {"storage/file/checksum.cpp", "tests/golden/spec_reader.cpp",
        "tests/tools/trace_file/spec_trace_test.cpp"}},
      {"curl", {"storage/http/range_client.cpp"}},
      {"zlib",
       {"octree/builder/mesh/stream/packing_decoders.cpp", "tests/fuzz/",
        "tests/octree/builder/mesh/"}},
      {"zstd",
       {"octree/builder/mesh/stream/packing_decoders.cpp", "tests/fuzz/",
        "tests/octree/builder/mesh/"}},
      {"CGAL", {"tests/oracle/", "tests/differential/", "tests/soak/", "bench/"}},
      {"embree", {"tests/oracle/", "bench/"}},
      {"Eigen", {"include/planetree/eigen.h", "octree/", "tests/", "bench/"}},
  };
  return all;
}

}  // namespace planetree::layering
