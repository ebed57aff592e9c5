#include "octree/builder/mesh/obj/obj_notes.h"

#include <algorithm>
#include <span>

namespace planetree::octree {

namespace {

/// Statements that are read over because they carry no surface: attributes, and data that only
/// other statements refer to.
constexpr std::string_view kAttributes[] = {
    "vn",        "vt",     "vp",  "g",    "o",     "s",        "mtllib",   "usemtl",
    "usemap",    "maplib", "mg",  "lod",  "bevel", "c_interp", "d_interp", "shadow_obj",
    "trace_obj", "cstype", "deg", "bmat", "step",  "parm",     "trim",     "hole",
    "scrv",      "sp",     "end", "con",  "stech", "ctech"};
constexpr std::string_view kPointsAndLines[] = {"p", "l"};
constexpr std::string_view kFreeForms[] = {"curv", "curv2", "surf", "bsp", "bzp",
                                           "cdc",  "cdp",   "res",  "call"};

bool is_one_of(std::string_view keyword, std::span<const std::string_view> names) {
  return std::find(names.begin(), names.end(), keyword) != names.end();
}

}  // namespace

void ObjNotes::add(std::uint64_t line, std::string_view keyword) {
  if (keyword.empty() || keyword.front() == '#' || is_one_of(keyword, kAttributes)) return;
  MeshNote& note = is_one_of(keyword, kPointsAndLines) ? points_and_lines_
                   : is_one_of(keyword, kFreeForms)    ? free_forms_
                                                       : unknown_;
  note.add(line, keyword);
}

std::vector<std::string> ObjNotes::texts() const {
  std::vector<std::string> texts;
  if (free_forms_)
    texts.push_back(free_forms_.counted("statement") +
                    " of curves, patches or other files not read, " + free_forms_.first() +
                    "; export them as faces");
  if (points_and_lines_)
    texts.push_back(points_and_lines_.counted("point or line statement") + " not read, " +
                    points_and_lines_.first());
  if (unknown_)
    texts.push_back(unknown_.counted("unknown statement") + " not read, " + unknown_.first());
  return texts;
}

}  // namespace planetree::octree
