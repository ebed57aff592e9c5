#include <cstddef>
#include <exception>
#include <span>

#include "c/c_values.h"
#include "planetree/build.h"
#include "planetree/c.h"

namespace planetree::c {
namespace {

BuildOptions options_of(const planetree_build_options* given) {
  BuildOptions options;
  if (!given) return options;
  options.memory_bytes = given->memory_bytes;
  options.threads = given->threads;
  options.page_bytes = given->page_bytes;
  options.layers = given->layers;
  options.side = given->side_rule == PLANETREE_RULE_SOLID     ? SideChoice::kSolid
                 : given->side_rule == PLANETREE_RULE_SURFACE ? SideChoice::kSurface
                                                              : SideChoice::kAuto;
  if (given->temp_directory) options.temp_directory = given->temp_directory;
  options.keep = given->keep;
  options.member_bytes = given->member_bytes;
  if (given->value_property) options.value_property = given->value_property;
  options.resume = given->resume;
  options.strict = given->strict;
  options.replace = given->replace;
  if (given->on_progress)
    options.on_progress = [given](BuildPhase phase, std::uint64_t done, std::uint64_t total) {
      return given->on_progress(given->context, name_of(phase), done, total);
    };
  return options;
}

std::uint32_t build(const BuildInput& input, const char* output,
                    const planetree_build_options* options, planetree_build_report* report,
                    planetree_error* error) {
  if (!are_set(options)) return fail_for_unset_options(error);
  const Result<BuildReport> built = planetree::build(input, output, options_of(options));
  if (!built) return fail(built.error(), error);
  if (report)
    *report = {built->triangles,
               built->skipped,
               built->unbalanced_edges,
               built->file_bytes,
               static_cast<std::uint32_t>(built->side_rule),
               built->layers};
  return PLANETREE_OK;
}

// Runs a build. Paths and inputs allocate, which may throw.
template <class Build>
std::uint32_t run(planetree_error* error, const Build& build) noexcept {
  try {
    return build();
  } catch (const std::exception&) {
    return fail_without_memory(error);
  }
}

}  // namespace
}  // namespace planetree::c

void planetree_default_build_options(planetree_build_options* options) noexcept {
  const planetree::BuildOptions defaults;
  *options = {};
  options->struct_bytes = sizeof *options;
  options->page_bytes = defaults.page_bytes;
  options->layers = defaults.layers;
}

const char* planetree_version(void) noexcept { return PLANETREE_VERSION; }

uint32_t planetree_build(const char* mesh, const char* output,
                         const planetree_build_options* options, planetree_build_report* report,
                         planetree_error* error) noexcept {
  return planetree::c::run(error, [&] {
    return planetree::c::build(planetree::BuildInput(mesh), output, options, report, error);
  });
}

uint32_t planetree_build_mesh(const double* vertices, size_t vertex_count,
                              const uint32_t* triangles, size_t triangle_count, const char* output,
                              const planetree_build_options* options,
                              planetree_build_report* report, planetree_error* error) noexcept {
  return planetree::c::run(error, [&] {
    const std::span places(reinterpret_cast<const planetree::Vec3*>(vertices), vertex_count);
    const std::span corners(reinterpret_cast<const planetree::TriangleVertices*>(triangles),
                            triangle_count);
    return planetree::c::build(planetree::BuildInput(places, corners), output, options, report,
                               error);
  });
}
