#include <gtest/gtest.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "octree/builder/mesh/mesh_size.h"
#include "tests/octree/builder/mesh/mesh_formats.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"
#include "tests/storage/system/faulty_calls.h"

namespace planetree::octree {
namespace {

std::string gzipped(std::string text) {
  z_stream stream = {};
  EXPECT_EQ(::deflateInit2(&stream, 6, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY), Z_OK);
  std::string packed(::deflateBound(&stream, text.size()) + 64, '\0');
  stream.next_in = reinterpret_cast<Bytef*>(text.data());
  stream.avail_in = static_cast<uInt>(text.size());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_out = static_cast<uInt>(packed.size());
  EXPECT_EQ(::deflate(&stream, Z_FINISH), Z_STREAM_END);
  packed.resize(packed.size() - stream.avail_out);
  ::deflateEnd(&stream);
  return packed;
}

/// A frame with a checksum and, unless `window_log` is 0, with a window of that size.
std::string zstd_packed(std::string text, int window_log = 0) {
  ZSTD_CCtx* const context = ::ZSTD_createCCtx();
  ::ZSTD_CCtx_setParameter(context, ZSTD_c_checksumFlag, 1);
  if (window_log != 0) ::ZSTD_CCtx_setParameter(context, ZSTD_c_windowLog, window_log);
  std::string packed(::ZSTD_compressBound(text.size()) + 64, '\0');
  ZSTD_inBuffer in{text.data(), text.size(), 0};
  ZSTD_outBuffer out{packed.data(), packed.size(), 0};
  // In two calls, so that the window is not cut down to the length of the text.
  ::ZSTD_compressStream2(context, &out, &in, ZSTD_e_continue);
  EXPECT_EQ(::ZSTD_compressStream2(context, &out, &in, ZSTD_e_end), 0U);
  packed.resize(out.pos);
  ::ZSTD_freeCCtx(context);
  return packed;
}

struct Packer {
  const char* name;
  const char* extension;
  std::string (*pack)(std::string text);
};
const std::vector<Packer> kPackers = {
    {"gzip", ".gz", gzipped},
    {"zstd", ".zst", [](std::string text) { return zstd_packed(std::move(text)); }}};

/// Some triangles over a square of `side` times `side` vertices.
PlainMesh grid(std::int64_t side) {
  PlainMesh mesh;
  for (std::int64_t i = 0; i < side * side; ++i)
    mesh.vertices.push_back({static_cast<float>(i % side), static_cast<float>(i / side),
                             static_cast<float>(i * i % 7) / 8});
  for (std::int64_t i = 0; i + 1 < side; ++i)
    for (std::int64_t j = 0; j + 1 < side; ++j)
      mesh.faces.push_back({i * side + j, i * side + j + 1, (i + 1) * side + j});
  return mesh;
}

const char* const kObj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const char* const kObjLog = "0: 0 0 0, 1 0 0, 0 1 0\n";

TEST(MeshPacking, GivesTheTrianglesOfTheContentInEveryFormat) {
  for (const Packer& packer : kPackers)
    for (const MeshFormat& format : formats_that([](const MeshFormat&) { return true; })) {
      const std::string text = format.write(grid(40), {});
      const Reading plain = read_bytes(text, format.extension);
      for (const std::uint64_t memory : {std::uint64_t{1} << 16, MeshScratch::kMemoryBytes}) {
        const Reading packed =
            read_bytes(packer.pack(text), std::string(format.extension) + packer.extension, memory);
        ASSERT_TRUE(packed.summary) << packer.name << format.name << packed.error;
        EXPECT_EQ(packed.log, plain.log);
        EXPECT_EQ(packed.summary->vertex_records, plain.summary->vertex_records);
      }
    }
}

TEST(MeshPacking, IsRecognisedByContentAndNotByName) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const Packer& packer : kPackers) {
    for (const char* extension : {"", ".bin", ".off", ".ply"})
      EXPECT_EQ(read_bytes(packer.pack(off), extension).log, kObjLog) << extension;
    for (const char* extension : {".obj", ".obj.gz", ".OBJ.GZ", ".obj.zst", ".Obj.Zst"})
      EXPECT_EQ(read_bytes(packer.pack(kObj), extension).log, kObjLog) << extension;
    EXPECT_EQ(read_bytes(packer.pack(kObj), ".gz").code, ErrorCode::kBadInput);
  }
  EXPECT_EQ(read_bytes(off, ".off.gz").log, kObjLog);  // not compressed at all
}

TEST(MeshPacking, LeavesABinaryStlAloneWhoseTitleLooksCompressed) {
  for (const MeshFormat& format :
       formats_that([](const MeshFormat& f) { return std::string(f.name) == "StlBinary"; })) {
    std::string text = format.write(grid(3), {});
    const std::string log = read_bytes(text).log;
    for (const char* magic : {"\x1f\x8b\x08", "\x28\xb5\x2f\xfd"}) {
      text.replace(0, std::string(magic).size(), magic);
      EXPECT_EQ(read_bytes(text).log, log);
    }
  }
}

TEST(MeshPacking, ReadsSeveralMembersAndFrames) {
  const std::string text = kObj;
  for (const Packer& packer : kPackers)
    for (std::size_t cut = 0; cut <= text.size(); ++cut) {
      const std::string packed = packer.pack(text.substr(0, cut)) + packer.pack(text.substr(cut));
      EXPECT_EQ(read_bytes(packed, ".obj").log, kObjLog) << cut;
    }
  EXPECT_EQ(read_bytes(gzipped(text) + std::string(700, '\0'), ".obj").log, kObjLog);
  const std::string skippable("\x50\x2a\x4d\x18\x03\0\0\0abc", 11);
  EXPECT_EQ(read_bytes(zstd_packed(text) + skippable, ".obj").log, kObjLog);
}

TEST(MeshPacking, RefusesWhatEndsTooEarlyAndNamesThePlace) {
  for (const Packer& packer : kPackers) {
    const std::string packed = packer.pack(kObj);
    for (std::size_t size = 4; size < packed.size(); ++size) {
      const Reading reading = read_bytes(packed.substr(0, size), ".obj");
      EXPECT_EQ(reading.code, ErrorCode::kBadInput);
      EXPECT_EQ(reading.offset, size);
      EXPECT_EQ(reading.error, "byte " + std::to_string(size) + ": the " + packer.name +
                                   " data ends too early; get the file again");
      EXPECT_EQ(reading.log, "");
    }
  }
}

TEST(MeshPacking, RefusesDamageAndNamesThePlace) {
  const std::string text = mesh_formats::text_body(grid(9)) + kObj;
  for (const Packer& packer : kPackers) {
    const std::string packed = packer.pack(text);
    const Reading sound = read_bytes(packed, ".obj");
    ASSERT_TRUE(sound.summary) << sound.error;
    std::size_t refused = 0;
    for (std::size_t k = 4; k < packed.size(); ++k) {
      std::string damaged = packed;
      damaged[k] = static_cast<char>(damaged[k] ^ 0x55);
      const Reading reading = read_bytes(damaged, ".obj");
      // The head of a gzip member has bytes without meaning.
      if (reading.summary) {
        EXPECT_EQ(reading.log, sound.log);
        continue;
      }
      ++refused;
      EXPECT_LE(reading.offset, packed.size());
      EXPECT_TRUE(reading.code == ErrorCode::kBadInput || reading.code == ErrorCode::kNoMemory);
      EXPECT_TRUE(reading.error.starts_with("byte " + std::to_string(reading.offset) + ": "));
    }
    EXPECT_GT(refused, packed.size() - 20);
    const Reading more = read_bytes(packed + "more", ".obj");
    EXPECT_EQ(more.code, ErrorCode::kBadInput);
    EXPECT_GE(more.offset, packed.size());
    EXPECT_LE(more.offset, packed.size() + 4);
  }
}

TEST(MeshPacking, RefusesByNameWhatIsCompressedTwice) {
  const Reading gzip = read_bytes(zstd_packed(gzipped(kObj)), ".obj");
  EXPECT_EQ(gzip.code, ErrorCode::kBadInput);
  EXPECT_EQ(gzip.error,
            "byte 0: the file is compressed again with gzip; unpack it until it is a mesh");
  const Reading zstd = read_bytes(gzipped(zstd_packed(kObj)), ".obj");
  EXPECT_EQ(zstd.code, ErrorCode::kBadInput);
  EXPECT_NE(zstd.error.find("compressed again with zstd"), std::string::npos);
}

TEST(MeshPacking, RefusesAWindowThatDoesNotFitIntoMemory) {
  const std::string packed = zstd_packed(std::string(3 << 20, '#') + "\n" + kObj, 25);
  EXPECT_EQ(read_bytes(packed, ".obj").log, kObjLog);
  const Reading little = read_bytes(packed, ".obj", 1 << 20);
  EXPECT_EQ(little.code, ErrorCode::kNoMemory);
  EXPECT_NE(little.error.find("needs a window of more than 8 MiB; give more --memory"),
            std::string::npos);
}

/// Fails from some progress on.
class ImpatientSink final : public TriangleSink {
 public:
  explicit ImpatientSink(std::size_t max_reports) : max_reports_(max_reports) {}

  Result<void> triangle(std::uint64_t, const std::array<Vec3, 3>&) override { return {}; }
  void skipped(std::uint64_t, std::uint64_t, const SkippedRecord&) override {}
  Result<void> progress(std::uint64_t done, std::uint64_t total) override {
    EXPECT_GE(done, done_);
    EXPECT_LE(done, total);
    EXPECT_GE(total, total_);
    done_ = done;
    total_ = total;
    if (++reports < max_reports_) return {};
    return make_error(ErrorCode::kCancelled, Error::kNowhere, Error::kNowhere, "enough");
  }

  std::size_t reports = 0;

 private:
  std::size_t max_reports_;
  std::uint64_t done_ = 0, total_ = 0;
};

TEST(MeshPacking, ReportsProgressAndCanBeCancelled) {
  const std::string text = std::string("#") + std::string(20 << 20, ' ') + "\n" + kObj;
  for (const Packer& packer : kPackers) {
    const TemporaryFile file(packer.pack(text), ".obj");
    ImpatientSink patient(1000);
    EXPECT_TRUE(read_mesh(file.path(), patient));
    EXPECT_GE(patient.reports, 6U);
    for (std::size_t stop = 1; stop <= patient.reports; ++stop) {
      ImpatientSink sink(stop);
      const auto summary = read_mesh(file.path(), sink);
      ASSERT_FALSE(summary);
      EXPECT_EQ(summary.error().code, ErrorCode::kCancelled);
      EXPECT_EQ(sink.reports, stop);
    }
  }
}

TEST(MeshPacking, CountsItsContentAmongTheTemporaryBytes) {
  const std::string text = mesh_formats::text_body(grid(30)) + kObj;
  for (const Packer& packer : kPackers) {
    const TemporaryFile file(packer.pack(text), ".obj");
    MeshScratch scratch;
    EXPECT_TRUE(read_path(file.path(), scratch).summary);
    EXPECT_EQ(scratch.disk_bytes(), text.size());
    storage::FaultyCalls calls;
    calls.fault = storage::FaultyCalls::Fault::kError;
    calls.number = ENOSPC;
    calls.every = true;
    calls.fault_at = 4;  // the mesh is open, and its first bytes are read
    MeshScratch faulty(MeshScratch::kMemoryBytes, std::filesystem::temp_directory_path(), calls);
    EXPECT_FALSE(read_path(file.path(), faulty).summary);
  }
}

// Room is asked for before every 64 MiB but the first.
TEST(MeshPacking, StopsWhereThereIsNoRoomForMore) {
  const std::string text(200 << 20, ' ');
  for (const Packer& packer : kPackers) {
    const TemporaryFile file(packer.pack(text), ".obj");
    MeshScratch scratch;
    std::uint64_t asked = 0;
    scratch.before_unpacking([&asked](std::uint64_t bytes) -> Result<void> {
      asked += bytes;
      if (asked < 128 << 20) return {};
      return make_error(ErrorCode::kNoSpace, Error::kNowhere, Error::kNowhere, "full");
    });
    const Reading reading = read_path(file.path(), scratch);
    EXPECT_EQ(reading.code, ErrorCode::kNoSpace);
    EXPECT_EQ(asked, std::uint64_t{128} << 20);
    EXPECT_LE(scratch.disk_bytes(), asked);
    EXPECT_GT(scratch.disk_bytes() + (1 << 20), asked);
  }
}

TEST(MeshPacking, StatesTheLengthOfItsContent) {
  const std::string text = mesh_formats::text_body(grid(30));
  for (const Packer& packer : kPackers) {
    const TemporaryFile file(packer.pack(text), ".obj");
    const auto size = MeshSize::estimate(file.path());
    ASSERT_TRUE(size);
    EXPECT_EQ(size->triangles, 0U);
    const bool is_stated = std::string(packer.name) == "gzip";
    EXPECT_EQ(size->unpacked_bytes, is_stated ? text.size() : packer.pack(text).size());
  }
}

}  // namespace
}  // namespace planetree::octree
