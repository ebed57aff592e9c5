// Several files are read as one mesh.

#include "octree/builder/mesh/sequence/mesh_sequence.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "octree/builder/mesh/mesh_size.h"
#include "tests/octree/builder/mesh/mesh_recorder.h"

namespace planetree::octree {
namespace {

constexpr std::string_view kObj =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nl 1 2\nf 1 2 3\nf 1 2 9\nf 2 3 4\n";
constexpr std::string_view kOff = "OFF\n4 1 0\n0 0 5\n1 0 5\n1 1 5\n0 1 5\n4 0 1 2 3\n";

std::string ply(const std::string& value_type, const std::string& bad = "2") {
  return "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty " +
         value_type + " value\nend_header\n0 0 7\n1 0 7\n0 1 7\n3 0 1 " + bad + " 4\n";
}

BuildInput input_of(const std::vector<const TemporaryFile*>& files) {
  std::vector<std::filesystem::path> paths;
  for (const TemporaryFile* file : files) paths.push_back(file->path());
  return BuildInput(paths);
}

TEST(MeshSequence, NumbersTheTrianglesOfAllFiles) {
  const TemporaryFile obj(kObj, ".obj"), off(kOff, ".off"), last(ply("int"), ".ply");
  MeshScratch scratch;
  const Reading reading = read_input(input_of({&obj, &off, &last}), scratch);
  ASSERT_TRUE(reading.summary) << reading.error;
  EXPECT_EQ(reading.log,
            "0: 0 0 0, 1 0 0, 0 1 0\n"
            "1+1 aside: " +
                obj.path().string() +
                ": line 7: vertex index 9 is out of range, the mesh has 4 vertices\n"
                "2: 1 0 0, 0 1 0, 0 0 1\n"
                "3: 0 0 5, 1 0 5, 1 1 5\n"
                "4: 0 0 5, 1 1 5, 0 1 5\n"
                "5: 0 0 7, 1 0 7, 0 1 7\n");
  EXPECT_EQ(reading.summary->triangle_indices, 6u);
  EXPECT_EQ(reading.summary->vertex_records, 11u);
  EXPECT_EQ(reading.summary->face_records, 5u);
  EXPECT_EQ(reading.summary->file_indices, (std::vector<std::uint64_t>{3, 2, 1}));
  EXPECT_FALSE(reading.summary->float32);
  ASSERT_EQ(reading.summary->notes.size(), 1u);
  EXPECT_TRUE(reading.summary->notes[0].starts_with(obj.path().string() + ": 1 point or line"));
  EXPECT_TRUE(scratch.file().empty());
}

TEST(MeshSequence, NamesTheFileOfAnOddPolygon) {
  const TemporaryFile off(kOff, ".off"),
      odd("OFF\n4 1 0\n0 0 5\n1 1 5\n1 0 5\n0 1 5\n4 0 1 2 3\n", ".off");
  MeshScratch scratch;
  const Reading reading = read_input(input_of({&off, &odd, &odd}), scratch);
  ASSERT_TRUE(reading.summary) << reading.error;
  EXPECT_EQ(reading.summary->odd_polygons.fanned, 2u);
  EXPECT_TRUE(
      reading.summary->odd_polygons.first_fanned.starts_with(odd.path().string() + ": face 0"))
      << reading.summary->odd_polygons.first_fanned;
}

TEST(MeshSequence, CountsTheBytesOfAllFiles) {
  const TemporaryFile obj(kObj, ".obj"), off(kOff, ".off");
  const std::uint64_t bytes = kObj.size() + kOff.size();
  RecordingSink sink;
  ASSERT_TRUE(read_mesh(input_of({&obj, &off}), sink));
  ASSERT_GE(sink.reports.size(), 2u);
  std::uint64_t before = 0;
  for (const auto& [done, total] : sink.reports) {
    EXPECT_EQ(total, bytes);
    EXPECT_GE(done, before);
    before = done;
  }
  EXPECT_EQ(sink.reports.front().first, kObj.size());
  EXPECT_EQ(before, bytes);
}

TEST(MeshSequence, NamesTheFileOfAnError) {
  const TemporaryFile obj(kObj, ".obj"), off(kOff, ".off"), bad("OFF\n4 x 0\n", ".off");
  MeshScratch scratch;
  const Reading reading = read_input(input_of({&obj, &bad, &off}), scratch);
  EXPECT_EQ(reading.code, ErrorCode::kBadInput);
  EXPECT_EQ(scratch.file(), bad.path());
  const TemporaryFile empty("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", ".off");
  EXPECT_FALSE(read_input(input_of({&obj, &empty}), scratch).summary);
  EXPECT_EQ(scratch.file(), empty.path());
}

TEST(MeshSequence, FindsAMissingFileBeforeItReads) {
  const TemporaryFile obj(kObj, ".obj");
  RecordingSink sink;
  MeshScratch scratch;
  const BuildInput input(std::vector<std::filesystem::path>{obj.path(), "/no/such.obj"});
  const auto summary = read_mesh(input, sink, scratch);
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kNotFound);
  EXPECT_EQ(scratch.file(), "/no/such.obj");
  EXPECT_EQ(sink.log, "");
  std::filesystem::path failed_at;
  const auto size = MeshSize::estimate(input, storage::FileCalls::real(), {}, &failed_at);
  EXPECT_FALSE(size);
  EXPECT_EQ(failed_at, "/no/such.obj");
}

TEST(MeshSequence, RefusesAnEmptyList) {
  MeshScratch scratch;
  const Reading reading = read_input(BuildInput(std::vector<std::filesystem::path>()), scratch);
  EXPECT_EQ(reading.code, ErrorCode::kBadArgument);
  EXPECT_EQ(reading.error, "an empty list of mesh files; give at least one");
}

TEST(MeshSequence, KeepsAttributesThatAllFilesHave) {
  const TemporaryFile one(ply("int"), ".ply"), two(ply("short"), ".ply"),
      real(ply("float"), ".ply"), unsigned_one(ply("uchar"), ".ply"), off(kOff, ".off");
  MeshScratch scratch;
  const MeshOptions keep{.keep = kKeepValue};
  const Reading both = read_input(input_of({&one, &two}), scratch, keep);
  ASSERT_TRUE(both.summary) << both.error;
  EXPECT_EQ(both.summary->value_kind, ValueKind::kSigned);
  const Reading mixed = read_input(input_of({&one, &two, &real}), scratch, keep);
  EXPECT_EQ(mixed.code, ErrorCode::kBadInput);
  EXPECT_EQ(mixed.error,
            "its values are reals, and those of the files before it are signed integers; give all "
            "files values of one type, or build without --keep value");
  EXPECT_EQ(scratch.file(), real.path());
  EXPECT_FALSE(read_input(input_of({&unsigned_one, &one}), scratch, keep).summary);
  EXPECT_EQ(scratch.file(), one.path());
  EXPECT_TRUE(read_input(input_of({&one, &two, &real, &off}), scratch).summary);
  EXPECT_FALSE(read_input(input_of({&one, &off}), scratch, keep).summary);
  EXPECT_EQ(scratch.file(), off.path());
}

TEST(MeshSequence, EstimatesTheSizeOfAllFiles) {
  const TemporaryFile off(kOff, ".off"), obj(kObj, ".obj"), last(ply("int"), ".ply");
  MeshSize sum;
  for (const TemporaryFile* file : {&off, &obj, &last}) {
    const auto size = MeshSize::estimate(file->path());
    ASSERT_TRUE(size);
    sum.add(*size);
  }
  const auto size = MeshSize::estimate(input_of({&off, &obj, &last}));
  ASSERT_TRUE(size);
  EXPECT_GE(size->triangles, 5u);
  EXPECT_EQ(size->triangles, sum.triangles);
  EXPECT_EQ(size->vertices, sum.vertices);
  EXPECT_TRUE(size->float64);
}

}  // namespace
}  // namespace planetree::octree
