// Answers as NumPy arrays and VTK files.

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <vector>

#include "tests/storage/system/temporary_directory.h"
#include "tests/tools/arrays/read_npy.h"
#include "tests/tools/arrays/read_vtp.h"
#include "tests/tools/cli/captured_console.h"
#include "tools/answers/answer_writer.h"

namespace planetree::tools {
namespace {

using Doubles = std::vector<double>;
constexpr double kFar = std::numeric_limits<double>::infinity();

ClosestPoint full_answer() {
  ClosestPoint answer;
  answer.distance = 0.1;
  answer.lower = 0.09;
  answer.upper = 1.0 / 3;
  answer.side = Side::kOnSurface;
  answer.point = {-0.0, 1e-5, 2};
  answer.normal = {0, -1, 0};
  answer.triangle = 12345678901234;
  answer.feature = Feature::kEdge;
  answer.status = Status::kWithinError;
  return answer;
}

ClosestPoint answer_without_triangle() {
  ClosestPoint answer;
  answer.distance = answer.upper = kFar;
  answer.status = Status::kBeyondMaxDistance;
  return answer;
}

AnswerForm form_of(AnswerFormat format, std::uint32_t parts = kAllParts) {
  AnswerForm form;
  form.format = format;
  form.parts = parts;
  return form;
}

class ArrayWriter : public testing::Test {
 protected:
  /// Writes the answers in two pieces.
  template <class Query, class Answer>
  std::string written(const AnswerForm& form, const std::vector<Query>& queries,
                      const std::vector<Answer>& answers, const char* name = "out") {
    CapturedConsole captured;
    const std::filesystem::path path = std::string(name) == "-" ? "-" : folder_ / name;
    auto output = AnswerOutput::open(path, true, captured.console());
    EXPECT_TRUE(output);
    AnswerWriter writer(*output, form);
    EXPECT_TRUE(writer.begin(Answer()));
    const auto half = queries.size() / 2;
    const std::span all_queries(queries);
    const std::span all_answers(answers);
    EXPECT_TRUE(writer.write(all_queries.first(half), all_answers.first(half)));
    EXPECT_TRUE(writer.write(all_queries.subspan(half), all_answers.subspan(half)));
    EXPECT_TRUE(writer.finish());
    EXPECT_TRUE(output->commit());
    if (path == "-") return captured.output();
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  storage::TemporaryDirectory folder_;
  const std::vector<Vec3> points_ = {{1, 2, 0.1}, {4, 5, 6}};
  const std::vector<ClosestPoint> answers_ = {full_answer(), answer_without_triangle()};
};

TEST_F(ArrayWriter, WritesTheColumnsOfCsvAsFieldsOfANumpyArray) {
  const ReadNpy array = read_npy(written(form_of(AnswerFormat::kNpy), points_, answers_));
  EXPECT_EQ(array.header_bytes % 64, 0u);
  EXPECT_EQ(array.names(),
            "x,y,z,distance,lower,upper,side,px,py,pz,nx,ny,nz,triangle,feature,status");
  EXPECT_EQ(array.type_of("z"), "<f8");
  EXPECT_EQ(array.type_of("side"), "|u1");
  EXPECT_EQ(array.type_of("triangle"), "<i8");
  EXPECT_EQ(array.type_of("status"), "|u1");
  ASSERT_EQ(array.rows, 2u);
  EXPECT_EQ(array.columns.at("x"), (Doubles{1, 4}));
  EXPECT_EQ(array.columns.at("distance"), (Doubles{0.1, kFar}));
  EXPECT_EQ(array.columns.at("upper"), (Doubles{1.0 / 3, kFar}));
  EXPECT_EQ(array.columns.at("side"), (Doubles{2, 3}));
  EXPECT_EQ(array.columns.at("py")[0], 1e-5);
  EXPECT_EQ(array.columns.at("ny")[0], -1);
  EXPECT_EQ(array.columns.at("triangle"), (Doubles{12345678901234, -1}));
  EXPECT_EQ(array.columns.at("feature")[0], 1);
  EXPECT_EQ(array.columns.at("status"), (Doubles{1, 3}));
}

TEST_F(ArrayWriter, CountsTheRowsOfManyPieces) {
  const std::vector<Vec3> points(20'000, Vec3{7, 8, 9});
  const std::vector<ClosestPoint> answers(points.size(), full_answer());
  const ReadNpy array = read_npy(written(form_of(AnswerFormat::kNpy), points, answers));
  EXPECT_EQ(array.rows, points.size());
  EXPECT_EQ(array.columns.at("triangle").back(), 12345678901234);
}

TEST_F(ArrayWriter, LeavesOutFieldsThatWereNotRequested) {
  AnswerForm form = form_of(AnswerFormat::kNpy, kDistance);
  EXPECT_EQ(read_npy(written(form, points_, answers_)).names(),
            "x,y,z,distance,lower,upper,px,py,pz,triangle,feature,status");
  form.parts = kSide;
  EXPECT_EQ(read_npy(written(form, points_, answers_)).names(), "x,y,z,side,status");
  form.parts = kAllParts;
  form.signed_distance = true;
  const ReadNpy array = read_npy(written(form, points_, answers_));
  EXPECT_TRUE(std::isnan(array.columns.at("signed_distance")[1]));
  const std::vector<Containment> sides = {{Side::kInside, Status::kExact},
                                          {Side::kUnknown, Status::kDegraded}};
  const ReadNpy contained = read_npy(written(form_of(AnswerFormat::kNpy), points_, sides));
  EXPECT_EQ(contained.names(), "x,y,z,side,status");
  EXPECT_EQ(contained.columns.at("side"), (Doubles{0, 3}));
}

RayHit sample_ray_hit() {
  RayHit hit;
  hit.t = 0.75;
  hit.point = {7, 8, 9};
  hit.normal = {0, -1, 0};
  hit.triangle = 5;
  hit.entering = true;
  hit.status = Status::kExact;
  return hit;
}

TEST_F(ArrayWriter, WritesRaysAndSweepsAsNumpyArrays) {
  const std::vector<Ray> rays(2, Ray{{1, 2, 0.1}, {0, 0, -1}, 0.5, kFar});
  AnswerForm form = form_of(AnswerFormat::kNpy);
  form.shows_range = true;
  const ReadNpy hits = read_npy(written(form, rays, std::vector{sample_ray_hit(), RayHit()}));
  EXPECT_EQ(hits.names(),
            "x,y,z,dx,dy,dz,t_min,t_max,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,entering,"
            "status");
  EXPECT_EQ(hits.type_of("entering"), "|b1");
  EXPECT_EQ(hits.columns.at("entering"), (Doubles{1, 0}));
  EXPECT_EQ(hits.columns.at("triangle"), (Doubles{5, -1}));
  EXPECT_EQ(hits.columns.at("t_min"), (Doubles{0.5, 0.5}));
  EXPECT_EQ(hits.columns.at("py")[0], 8);
  EXPECT_TRUE(std::isnan(hits.columns.at("py")[1]));
  FirstContact contact;
  contact.t = 0.75;
  contact.at = full_answer();
  contact.status = Status::kDegraded;
  const std::vector<Sweep> sweeps(2, Sweep{{1, 2, 3}, {4, 5, 6}, 0.1});
  const ReadNpy contacts =
      read_npy(written(form_of(AnswerFormat::kNpy), sweeps, std::vector{contact, FirstContact()}));
  EXPECT_EQ(contacts.names(),
            "x0,y0,z0,x1,y1,z1,radius,t,t_lower,t_upper,px,py,pz,nx,ny,nz,triangle,feature,status");
  EXPECT_EQ(contacts.columns.at("feature"), (Doubles{1, 255}));
  EXPECT_EQ(contacts.columns.at("status"), (Doubles{2, 4}));
}

TEST_F(ArrayWriter, WritesSurfacePointsWithAllFieldsAsAVtkFile) {
  for (const char* name : {"out", "-"}) {
    const ReadVtp file = read_vtp(written(form_of(AnswerFormat::kVtp), points_, answers_, name));
    EXPECT_EQ(file.points, 1u);
    EXPECT_EQ(file.verts, 1u);
    EXPECT_EQ(file.scalars, "distance");
    EXPECT_EQ(file.values("Points"), (Doubles{-0.0, 1e-5, 2}));
    EXPECT_EQ(file.values("PointData/query"), (Doubles{1, 2, 0.1}));
    EXPECT_EQ(file.values("PointData/distance"), (Doubles{0.1}));
    EXPECT_EQ(file.values("PointData/lower"), (Doubles{0.09}));
    EXPECT_EQ(file.values("PointData/upper"), (Doubles{1.0 / 3}));
    EXPECT_EQ(file.values("PointData/side"), (Doubles{2}));
    EXPECT_EQ(file.values("PointData/normal"), (Doubles{0, -1, 0}));
    EXPECT_EQ(file.values("PointData/triangle"), (Doubles{12345678901234}));
    EXPECT_EQ(file.values("PointData/feature"), (Doubles{1}));
    EXPECT_EQ(file.values("PointData/status"), (Doubles{1}));
    EXPECT_EQ(file.arrays.at("PointData/normal").components, 3u);
    EXPECT_EQ(file.arrays.at("PointData/triangle").type, "Int64");
    EXPECT_EQ(file.arrays.at("PointData/side").type, "UInt8");
    EXPECT_EQ(file.arrays.size(), 12u);
  }
}

TEST_F(ArrayWriter, WritesQueriesWithTheirSideAsAVtkFile) {
  const std::vector<Containment> sides = {{Side::kInside, Status::kExact},
                                          {Side::kOutside, Status::kExact}};
  const ReadVtp file = read_vtp(written(form_of(AnswerFormat::kVtp), points_, sides));
  EXPECT_EQ(file.scalars, "side");
  EXPECT_EQ(file.values("Points"), (Doubles{1, 2, 0.1, 4, 5, 6}));
  EXPECT_EQ(file.values("PointData/side"), (Doubles{0, 1}));
}

TEST_F(ArrayWriter, WritesHitsAsAVtkFile) {
  const std::vector<Ray> rays(4, Ray{{1, 2, 0.1}, {0, 0, -1}, 0.5, kFar});
  const std::vector<RayHit> hits = {sample_ray_hit(), RayHit(), sample_ray_hit(), RayHit()};
  const ReadVtp file = read_vtp(written(form_of(AnswerFormat::kVtp), rays, hits));
  EXPECT_EQ(file.scalars, "t");
  EXPECT_EQ(file.values("Points"), (Doubles{7, 8, 9, 7, 8, 9}));
  EXPECT_EQ(file.values("PointData/origin"), (Doubles{1, 2, 0.1, 1, 2, 0.1}));
  EXPECT_EQ(file.values("PointData/t"), (Doubles{0.75, 0.75}));
  EXPECT_EQ(file.values("PointData/entering"), (Doubles{1, 1}));
}

}  // namespace
}  // namespace planetree::tools
