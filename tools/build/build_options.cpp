#include "tools/build/build_options.h"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <map>

#include "octree/builder/mesh/stream/mesh_text.h"
#include "storage/set/member_address.h"
#include "tools/cli/coordinate_text.h"
#include "tools/cli/layer_option.h"

namespace planetree::tools {
namespace {

constexpr std::uint64_t kMaxThreads = 1024;

std::string page_size_complaint(std::uint64_t bytes) {
  if (std::has_single_bit(bytes) && bytes >= BuildOptions::kMinPageBytes &&
      bytes <= BuildOptions::kMaxPageBytes)
    return {};
  return fmt::format("--page-size: {} is not a page size; give a power of two from 4K to 256K",
                     bytes);
}

std::string box_complaint(const std::string& text) {
  std::array<double, 6> values{};
  bool good = parse_coordinates(text, values);
  for (std::size_t axis = 0; axis < 3; ++axis) good = good && values[axis] <= values[axis + 3];
  if (good) return {};
  return fmt::format(
      "'{}' is not a box; give X0,Y0,Z0,X1,Y1,Z1, finite numbers with X0 <= X1, Y0 <= Y1 and Z0 <= "
      "Z1",
      octree::printable(text));
}

Box box_of(const std::string& text) {
  std::array<double, 6> v{};
  parse_coordinates(text, v);
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5]}};
}

std::string meta_complaint(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals != std::string::npos && equals > 0) return {};
  return fmt::format("'{}' is not KEY=TEXT, such as title=Statue", octree::printable(text));
}

// --unit, --up, --crs and --meta.
void add_metadata(SubcommandOptions& subcommand, Metadata& metadata,
                  std::vector<std::string>& others) {
  const auto accept = [](const std::string&) { return std::string(); };
  const auto set = [&metadata](const char* key) {
    return [&metadata, key](const std::string& text) { metadata[key] = text; };
  };
  subcommand.text("--unit", "UNIT", accept, set("unit"),
                  "Unit of length of the mesh, such as mm, m or ft, which the file states. No "
                  "answer depends on it");
  subcommand.word("--up", {"x", "y", "z", "-x", "-y", "-z"}, set("up"),
                  "Axis that points up, which the file states. No answer depends on it");
  subcommand.text("--crs", "CRS", accept, set("crs"),
                  "Coordinate reference system of the mesh, such as EPSG:25832, which the file "
                  "states. No answer depends on it");
  subcommand.texts("--meta", "KEY=TEXT", meta_complaint, others,
                   "Further text that the file states, such as title, description, licence or "
                   "source; it may be given several times. generator= without a text leaves out "
                   "the program's name and version");
}

std::string memory_complaint(std::uint64_t bytes) {
  constexpr std::uint64_t kMin = BuildOptions::kMinMemoryBytes;
  if (bytes == 0 || bytes >= kMin) return {};
  return fmt::format("--memory: {} is too little for a build; give {}M or more", bytes, kMin >> 20);
}

}  // namespace

void add_resources(SubcommandOptions& subcommand, BuildOptions& options, BuildOptionTexts& text) {
  subcommand.default_text(
      subcommand.count(
          "--threads", text.threads, kMaxThreads,
          "Number of threads; 0 means one for each processor. The file does not depend on it"),
      "0");
  subcommand.default_text(
      subcommand.bytes("--memory", options.memory_bytes,
                       "Maximum memory for the build; data that does not fit goes to temporary "
                       "files. The file does not depend on it"),
      "a quarter of the machine's memory");
}

void add_set(SubcommandOptions& subcommand, BuildOptionTexts& text) {
  const auto set = subcommand.flag(
      "--set", text.set,
      "Write a set: members beside OUT.ptreeset hold the bytes of the file, and it lists them. For "
      "file systems and servers that refuse large files, and for machines that keep a part");
  const auto size = subcommand.bytes("--member-size", text.member_bytes,
                                     "Maximum length of a member of the set, from 64K on. Members "
                                     "are longer if there would be more than 256");
  SubcommandOptions::default_text(size, "4G");
  SubcommandOptions::need(size, set);
}

std::string take_set(const BuildOptionTexts& texts, const std::filesystem::path& output,
                     BuildOptions& options) {
  if (texts.set != storage::is_set_name(output.native()))
    return texts.set ? "--set: the output is named OUT.ptreeset; give it such a name"
                     : "an output that is named .ptreeset is a set; give --set too";
  if (!texts.set) return {};
  options.member_bytes = texts.member_bytes;
  if (texts.member_bytes >= BuildOptions::kMinMemberBytes) return {};
  return fmt::format("--member-size: {} is too little; give 64K or more", texts.member_bytes);
}

void add_box(SubcommandOptions& subcommand, BuildOptions& options) {
  subcommand.text(
      "--box", "X0,Y0,Z0,X1,Y1,Z1", box_complaint,
      [&options](const std::string& text) { options.box = box_of(text); },
      "Build only the triangles that touch this box, in model units. Sides and watertightness are "
      "those of the whole mesh. Answers are exact where the surface is nearer than the box's "
      "walls; intervals hold everywhere. Sides are known within the box");
}

KeepOptions add_content(SubcommandOptions& subcommand, BuildOptions& options,
                        BuildOptionTexts& text) {
  static const std::map<std::string, SideChoice> choices = {{"auto", SideChoice::kAuto},
                                                            {"solid", SideChoice::kSolid},
                                                            {"surface", SideChoice::kSurface}};
  subcommand.default_text(
      subcommand.word(
          "--side", {"auto", "solid", "surface"},
          [&options](const std::string& name) { options.side = choices.at(name); },
          "How queries decide sides by default. solid: by the winding number; surface: an open "
          "sheet "
          "such as a terrain has a front and a back, and the nearest face, edge or vertex decides; "
          "auto: surface if the mesh is not watertight and the sum of its area vectors is at least "
          "0.375 of its area"),
      "auto");
  add_layers(
      subcommand, options.layers,
      "Build only these layers of the file: distance (always built), side (sides of solids), "
      "field (answers within an error, and degraded ones), with commas between them. What is "
      "left out cannot be opened; sides of solids are unknown without side");
  const KeepOptions keep = add_keep(subcommand, options.keep, options.value_property);
  subcommand.default_text(
      subcommand.bytes("--page-size", text.page_bytes,
                       "Bytes of a page in memory: a power of two from 4K to 256K"),
      "64K");
  subcommand.flag(
      "--float64", options.float64,
      "Read coordinates that an ascii PLY declares as floats as doubles, with all their "
      "digits. The file is larger then");
  add_metadata(subcommand, options.metadata, text.metadata);
  subcommand.flag("--strict", options.strict,
                  "Refuse a mesh with bad records (a vertex that is not finite, an index out of "
                  "range, fewer than 3 corners) instead of skipping them");
  return keep;
}

std::string take_texts(const BuildOptionTexts& texts, const KeepOptions& keep,
                       BuildOptions& options) {
  options.page_bytes = static_cast<std::uint32_t>(texts.page_bytes);
  for (const std::string& text : texts.metadata) {
    const std::size_t equals = text.find('=');
    options.metadata[text.substr(0, equals)] = text.substr(equals + 1);
  }
  for (const std::string& complaint : {page_size_complaint(texts.page_bytes),
                                       take_texts(texts, options), keep.complaint(options.keep)})
    if (!complaint.empty()) return complaint;
  return {};
}

std::string take_texts(const BuildOptionTexts& texts, BuildOptions& options) {
  options.threads = static_cast<unsigned>(texts.threads);
  return memory_complaint(options.memory_bytes);
}

}  // namespace planetree::tools
