#include "tools/answers/ray_rows.h"

#include <algorithm>

namespace planetree::tools {

void RayRows::answer(std::span<const Ray> rays) {
  if (most_ == 1) {
    rows_.resize(rays.size());
    probe_.first_hits(rays, rows_, options_);
    ray_of_row_ = rays;
    return;
  }
  listed_.clear();
  rows_.clear();
  for (const Ray& ray : rays) answer(ray);
  ray_of_row_ = listed_;
}

void RayRows::answer(const Ray& ray) {
  constexpr std::size_t kFirst = 64;
  found_.resize(std::max<std::size_t>(found_.size(), std::min<std::uint64_t>(most_, kFirst)));
  Found found;
  std::size_t room = 0;
  for (;;) {
    room = std::min<std::size_t>(found_.size(), most_);
    found = probe_.all_hits(ray, std::span(found_).first(room), options_);
    if (found.count < room || room == most_) break;
    found_.resize(2 * room);
  }
  if (found.count == 0) {
    const RayHit first = probe_.first_hit(ray, options_);
    add(ray, first);
    // Pages may have arrived after the search for all hits.
    if (first.triangle == kNoTriangle) return;
  }
  double certain = ray.t_min;
  for (const RayHit& hit : std::span(found_).first(found.count)) {
    add(ray, hit);
    if (hit.status == Status::kExact) certain = hit.t_lower;
  }
  if (found.complete || found.count == most_) return;
  RayHit more;
  more.t_lower = certain;
  more.status = Status::kDegraded;
  add(ray, more);
}

void RayRows::add(const Ray& ray, const RayHit& hit) {
  listed_.push_back(ray);
  rows_.push_back(hit);
}

}  // namespace planetree::tools
