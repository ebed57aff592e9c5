#include "tests/soak/fielded_models.h"

#include <cmath>
#include <span>
#include <utility>

#include "tests/oracle/closed_models.h"
#include "tests/oracle/nasty_models.h"
#include "tests/oracle/sheet_models.h"

namespace planetree::oracle {
namespace {

constexpr std::uint32_t kSmallPages = 4096, kLargePages = 65536;
constexpr std::uint64_t kMuchMemory = std::uint64_t{1} << 32;
constexpr std::size_t kMinCount = 1100, kMaxCount = 3000;

FieldedModel made(std::string name, Soup triangles, std::uint32_t page_bytes = kSmallPages) {
  FieldedModel model;
  model.name = std::move(name);
  model.triangles = std::move(triangles);
  model.choices = {page_bytes, kMuchMemory, 3, std::nullopt, std::nullopt};
  return model;
}

FieldedModel moved(FieldedModel model, double factor, const Vec3& offset) {
  model.triangles = translated(scaled(std::move(model.triangles), factor), offset);
  model.size *= factor;
  model.middle = offset;
  return model;
}

// Every so many triangles is left out.
Soup pierced(const Soup& whole, std::size_t apart) {
  Soup kept;
  for (std::size_t i = 0; i < whole.size(); ++i)
    if (i % apart != 0) kept.push_back(whole[i]);
  return kept;
}

// Closed strays on three sides, a tenth as large as they are far; open ones lack a face.
FieldedModel with_strays(Soup core, double far, bool are_open) {
  FieldedModel model = made("strays at " + std::to_string(std::ilogb(far)) + " bits", {});
  const Vec3 places[] = {{far, far, far}, {0.1, -far, 0.2}, {-far, 0, far}};
  model.triangles = std::move(core);
  for (const Vec3& at : places) {
    Soup stray = tetrahedron(at, at + Vec3{0.1 * far, 0, 0}, at + Vec3{0, 0.1 * far, 0},
                             at + Vec3{0, 0, 0.1 * far});
    if (are_open) stray.pop_back();
    model.triangles = std::move(model.triangles) + stray;
  }
  model.stray = far;
  return model;
}

FieldedModel region(FieldedModel model, const Vec3& lower, const Vec3& upper) {
  model.name += ", a region";
  model.choices.box = octree::RegionBox{lower, upper};
  return model;
}

// A stray that hangs out of the core, far, and comes near it.
FieldedModel with_long_needle() {
  FieldedModel model = made("stray that starts in the core", ball(4));
  model.triangles.push_back({Vec3{0.2, 0.1, 0}, Vec3{0.2, 1e4, 0}, Vec3{0.3, 0.1, 1e3}});
  model.stray = 1e4;
  return model;
}

// Models of a family, side by side in part, until there are enough triangles.
FieldedModel many_of(const NastyFamily& family, std::uint64_t seed) {
  Random random(seed);
  Soup all;
  while (all.size() < kMinCount) {
    const Vec3 aside = random.one_in(2) ? Vec3{} : random.in_cube();
    all = std::move(all) + translated(family.make(random), aside);
  }
  if (all.size() > kMaxCount) all.resize(kMaxCount);
  FieldedModel model = made(std::string(family.name), std::move(all));
  model.choices.side = storage::SideRule::kSolid;
  return model;
}

FieldedModel plain(std::size_t number) {
  const double huge = std::ldexp(1.0, 100), tiny = std::ldexp(1.0, -100);
  switch (number) {
    case 0:
      return made("ball", ball(5));
    case 1:
      return made("ball with holes", pierced(ball(5), 100));
    case 2:
      return made("hills", hills(60));
    case 3:
      return region(made("ball", ball(5)), {-0.3, -0.2, -2}, {2, 0.8, 0.9});
    case 4:
      return with_strays(ball(4), 1e3, false);
    case 5:
      return moved(made("translated ball", ball(4)), 1, {1e9, -1e9, 3e8});
    case 6:
      return moved(made("great ball with holes", pierced(ball(5), 50)), huge, {});
    case 7:
      return moved(made("tiny hills", hills(40)), tiny, {});
    case 8:
      return made("large ball", ball(7), kLargePages);
    case 9:
      return made("nested balls", ball(4) + inside_out(scaled(ball(4), 0.5)) + ball(3));
    case 10:
      return made("panel with holes", holed_panel(40));
    case 11:
      return made("half pipe", half_pipe(30));
    case 12:
      return made("Moebius strip", moebius_strip(300));
    case 13:
      return with_strays(pierced(ball(4), 30), 1e10, true);
    case 14:
      return with_strays(ball(4), 1e30, false);
    case 15:
      return with_long_needle();
    case 16:
      return region(made("hills", hills(80)), {-0.5, -2, -2}, {0.3, 0.4, 2});
    case 17:
      return region(made("ball with holes", pierced(ball(5), 40)), {-2, -2, -0.4}, {2, 2, 0.4});
    case 18:
      return made("large hills", hills(316), kLargePages);
    case 19:
      return made("bowl", bowl(24));
    default:
      // Coordinates have few bits left.
      return moved(made("ball 2^" + std::to_string(3 * number - 30) + " away", ball(4)), 1,
                   {std::ldexp(1.0, 3 * static_cast<int>(number) - 30), -3, 1e3});
  }
}

}  // namespace

FieldedModel fielded_model(std::size_t number) {
  const std::span<const NastyFamily> nasty = nasty_families(), closed = closed_families();
  if (number < nasty.size()) return many_of(nasty[number], 70 + number);
  number -= nasty.size();
  if (number < closed.size()) return many_of(closed[number], 90 + number);
  return plain(number - closed.size());
}

}  // namespace planetree::oracle
