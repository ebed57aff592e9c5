#include "tests/soak/field_places.h"

#include <array>
#include <cmath>

#include "tests/oracle/nasty_models.h"

namespace planetree::oracle {
FieldPlaces::FieldPlaces(const FieldedModel& model, const BuiltModel& built)
    : model_(model), built_(built), last_(model.triangles[0][0]) {}

// A point of the grid; at_face: one that moves on a face of the grid's box.
Vec3 FieldPlaces::grid_point(Random& random, bool at_face) const {
  const storage::ModelRecord& record = built_.record();
  std::array<double, 3> at{};
  const std::size_t face = random.below(3);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t size = record.field_size[axis];
    double steps =
        at_face ? random.between(-0.5, size - 0.5) : static_cast<double>(random.below(size));
    if (at_face && axis == face) steps = random.one_in(2) ? 0 : size - 1;
    const double place = record.field_lower[axis] + steps * record.field_step;
    at[axis] = std::ldexp(one_ulp_off(random, place), -record.scale_exponent);
  }
  return {at[0], at[1], at[2]};
}

Vec3 FieldPlaces::in_box(Random& random, double reach) const {
  const ModelInfo& info = built_.model().info();
  const auto within = [&](double low, double high) {
    const double middle = low / 2 + high / 2;
    return middle + random.between(-reach, reach) * (high - middle);
  };
  const double x = within(info.core_lower.x, info.core_upper.x);
  const double y = within(info.core_lower.y, info.core_upper.y);
  const double z = within(info.core_lower.z, info.core_upper.z);
  return {x, y, z};
}

Vec3 FieldPlaces::place(Random& random) const {
  const bool has_field = built_.record().field_page_count > 0;
  switch (random.below(9)) {
    case 0:
      return in_box(random, 1.3);
    case 1:
      return in_box(random, random.magnitude(0, 6));
    case 2:
      return model_.middle + random.in_some_cube(0, 50) * model_.size;
    case 3:
      if (model_.stray == 0) break;
      if (random.one_in(2)) return random.in_cube() * (2 * model_.stray);
      return model_.triangles.back()[random.below(3)] + random.in_some_cube(-20, 0) * model_.stray;
    case 4:
    case 5:
      if (has_field) return grid_point(random, false);
      break;
    case 6:
      if (has_field) return grid_point(random, true);
      break;
    default:
      break;
  }
  return nasty_query(random, model_.triangles, model_.size);
}

Vec3 FieldPlaces::any(Random& random) { return last_ = place(random); }

Vec3 FieldPlaces::next(Random& random) {
  const double reach = random.one_in(8) ? -2 : -8;
  return last_ = last_ + random.in_some_cube(-30, reach) * model_.size;
}

}  // namespace planetree::oracle
