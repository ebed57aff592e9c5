// The caps of files are those that appendix B of the specification describes, in the same order.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "storage/file/checksum.h"
#include "tests/golden/samples.h"
#include "tests/golden/spec_tree.h"

namespace planetree::golden {
namespace {

using Cap = std::array<SpecPoint, 3>;

// Edges to close and how often each runs.
using Edges = std::map<std::pair<SpecPoint, SpecPoint>, int>;

void add(Edges& edges, const SpecPoint& from, const SpecPoint& to, int count) {
  if (from < to)
    edges[{from, to}] += count;
  else
    edges[{to, from}] -= count;
}

using Rank = std::pair<std::uint64_t, SpecPoint>;

Rank rank(const SpecPoint& vertex, int round) {
  const std::array<double, 4> words = {vertex[0], vertex[1], vertex[2], static_cast<double>(round)};
  return {storage::hash64(std::as_bytes(std::span(words))), vertex};
}

// Pairs the edges that enter a vertex, ordered by their other ends, with those that leave it.
void close_vertex(const SpecPoint& vertex, std::vector<SpecPoint> in, std::vector<SpecPoint> out,
                  Edges& left, std::vector<Cap>& caps) {
  std::ranges::sort(in);
  std::ranges::sort(out);
  const std::size_t pairs = std::min(in.size(), out.size());
  for (std::size_t i = 0; i < pairs; ++i) {
    caps.push_back({in[i], vertex, out[i]});
    add(left, in[i], out[i], 1);
  }
  for (std::size_t i = pairs; i < in.size(); ++i) add(left, in[i], vertex, 1);
  for (std::size_t i = pairs; i < out.size(); ++i) add(left, vertex, out[i], 1);
}

std::vector<Cap> close_by_rounds(Edges edges) {
  struct Vertex {
    std::vector<SpecPoint> in, out;
  };
  std::vector<Cap> caps;
  for (int round = 0; !edges.empty(); ++round) {
    std::map<Rank, Vertex> vertices;
    for (const auto& [edge, net] : edges) {
      const auto& [from, to] = net > 0 ? edge : std::pair(edge.second, edge.first);
      const bool leaves = rank(from, round) < rank(to, round);
      Vertex& vertex = vertices[rank(leaves ? from : to, round)];
      std::vector<SpecPoint>& ends = leaves ? vertex.out : vertex.in;
      ends.insert(ends.end(), static_cast<std::size_t>(std::abs(net)), leaves ? to : from);
    }
    Edges left;
    for (const auto& [at, vertex] : vertices)
      close_vertex(at.second, vertex.in, vertex.out, left, caps);
    std::erase_if(left, [](const auto& edge) { return edge.second == 0; });
    edges = std::move(left);
  }
  return caps;
}

void expect_caps_by_rounds(const SpecFile& file) {
  const SpecTree surface(file), caps(file, SpecTree::Of::kCaps);
  Edges edges;
  for (const SpecTriangle& triangle : surface.triangles(surface.root_link()))
    for (std::size_t k = 0; k < 3; ++k)
      if (triangle.corners[k] != triangle.corners[(k + 1) % 3])
        add(edges, triangle.corners[(k + 1) % 3], triangle.corners[k], 1);
  std::erase_if(edges, [](const auto& edge) { return edge.second == 0; });
  EXPECT_EQ(edges.size(), file.header().unbalanced_edges);
  std::vector<Cap> found(file.header().cap_count);
  for (const SpecTriangle& cap : caps.triangles(caps.root_link())) found.at(cap.id) = cap.corners;
  EXPECT_EQ(found, close_by_rounds(std::move(edges)));
}

TEST(SpecCapChoice, IsThatOfTheAppendix) {
  for (const Sample& sample : {sheet_sample(), tube_sample()})
    expect_caps_by_rounds(SpecFile(read_file(sample.ptree_path())));
  expect_caps_by_rounds(SpecFile(build_loose_sphere()));
  expect_caps_by_rounds(SpecFile(build_with_hole(sphere_sample(), 12)));
}

}  // namespace
}  // namespace planetree::golden
