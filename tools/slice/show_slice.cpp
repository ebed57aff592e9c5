#include "tools/slice/show_slice.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "tools/check/model_memory.h"
#include "tools/cli/open_model.h"
#include "tools/cli/progress.h"
#include "tools/picture/picture_file.h"
#include "tools/slice/slice_picture.h"
#include "tools/slice/slice_record.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMemoryBytes = std::uint64_t{256} << 20;

/// An error and the file that is at fault.
struct Failure {
  std::filesystem::path file;
  Error error;
};

std::optional<Failure> add_pages(FileParts& parts, const SliceCut& cut, SliceContents& contents) {
  auto map = page_map(parts, cut, contents.raster);
  if (!map) return Failure{contents.arguments.file, map.error()};
  contents.page_map = *std::move(map);
  contents.pages = pages_of(*contents.page_map);
  if ((contents.arguments.overlays & kResidencyOverlay) == 0) return std::nullopt;
  const std::filesystem::path& trace = contents.arguments.trace;
  const auto counted = count_lookups(trace, parts.header()->content_id, contents.pages);
  if (!counted) return Failure{trace, counted.error()};
  return std::nullopt;
}

// Adds what the tree itself shows. The file is read beside the model that answers.
std::optional<Failure> add_overlays(SliceContents& contents) {
  const SliceArguments& arguments = contents.arguments;
  const SliceOverlays overlays = arguments.overlays;
  if ((overlays & ~kWidthOverlay) == 0) return std::nullopt;
  auto parts = FileParts::open(arguments.file);
  if (!parts) return Failure{arguments.file, parts.error()};
  if (parts->header() == nullptr)
    return Failure{arguments.file, make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                                              "its header cannot be read; see planetree inspect")};
  const SliceCut cut(contents.raster, parts->header()->model);
  if ((overlays & kCellOverlay) != 0) {
    auto cells = cell_outlines(*parts, cut);
    if (!cells) return Failure{arguments.file, cells.error()};
    contents.cells = *std::move(cells);
  }
  if ((overlays & kDiscOverlay) != 0) {
    auto discs = disc_outlines(*parts, cut, static_cast<std::uint32_t>(arguments.level));
    if (!discs) return Failure{arguments.file, discs.error()};
    contents.discs = *std::move(discs);
  }
  if ((overlays & (kPageOverlay | kResidencyOverlay)) != 0) return add_pages(*parts, cut, contents);
  return std::nullopt;
}

std::vector<PixelAnswer> query_pixels(const SliceRaster& raster, Probe& probe,
                                      const SliceArguments& arguments) {
  Progress progress(arguments.quiet, arguments.json);
  std::uint64_t drawn = 0;
  auto answers =
      slice_field(raster, probe, arguments, [&](std::uint64_t done, std::uint64_t total) {
        if (done == 0) progress.start("drawing", total, "pixels");
        progress.add(done - drawn);
        drawn = done;
      });
  progress.finish();
  return answers;
}

}  // namespace

int show_slice(const SliceArguments& arguments, Console& console) {
  const std::string file = arguments.file.string();
  OpenOptions options;
  options.max_probes = 1;
  options.batch_threads = batch_threads_of(0);
  const auto memory = memory_without_limit(kMemoryBytes, arguments.file, options);
  if (!memory) return console.fail(file, memory.error());
  options.memory_budget_bytes = *memory;
  const auto model = open_model(arguments.file, options, console);
  if (!model) return console.fail(file, model.error());
  auto probe = Probe::create(*model);
  if (!probe) return console.fail(file, probe.error());
  const SliceRaster raster(model->info(), *arguments.plane);
  if (!raster.is_usable())
    return console.fail(
        file, make_error(ErrorCode::kBadArgument, Error::kNowhere, Error::kNowhere,
                         "the model's box is too large or too small to draw; choose another plane "
                         "or scale the model"));
  if (const std::string complaint = arguments.plane->complaint(model->info()); !complaint.empty())
    console.warn(file, complaint);
  std::vector<PixelAnswer> answers = query_pixels(raster, *probe, arguments);
  const SliceScales scales(answers, (arguments.overlays & kWidthOverlay) != 0,
                           raster.pixel_length());
  SliceContents contents{arguments, raster, std::move(answers), scales, {}, {}, {}, {}};
  if (const auto failure = add_overlays(contents))
    return console.fail(failure->file.string(), failure->error);
  const SlicePicture picture = draw_slice(contents);
  if (const auto written = write_picture(picture.drawing, arguments.image, arguments.replace_image);
      !written)
    return console.fail(arguments.image.string(), written.error());
  std::string report = slice_text(contents, picture);
  if (arguments.json) {
    nlohmann::ordered_json json = {{"image", arguments.image.string()}};
    json.update(slice_json(contents, picture));
    report = json_line(json);
  }
  if (arguments.image == "-")
    console.note(report);
  else
    console.print(report);
  const auto error = pages_lost(*model);
  return console.finish(error ? console.fail(file, *error) : kDone);
}

}  // namespace planetree::tools
