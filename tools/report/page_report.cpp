#include "tools/report/page_report.h"

#include <fmt/format.h>

#include <array>
#include <nlohmann/json.hpp>

#include "tools/cli/file_text.h"

namespace planetree::tools {
namespace {

using Json = nlohmann::ordered_json;

std::string_view codec_name(storage::Codec codec) {
  switch (codec) {
    case storage::Codec::kStored:
      return "stored";
    case storage::Codec::kLz4:
      return "lz4";
  }
  return "unknown";
}

Json entry_json(const storage::PageEntry& entry) {
  return {{"offset", entry.offset},
          {"check", fmt::format("{:016x}", entry.check)},
          {"octcode", fmt::format("0x{:016x}", entry.octcode)},
          {"cell", cell_text(entry.octcode)},
          {"codec", codec_name(entry.codec())},
          {"stored_bytes", entry.stored_bytes},
          {"raw_bytes", entry.raw_bytes}};
}

Json head_json(const octree::PageHead& head) {
  return {{"page_number", head.page_number},
          {"ordinal", head.ordinal},
          {"octcode", fmt::format("0x{:016x}", head.octcode)},
          {"node_count", head.node_count},
          {"block_count", head.block_count},
          {"root_count", head.root_count},
          {"child_count", head.child_count},
          {"page_link_count", head.page_link_count},
          {"vertex_count", head.vertex_count},
          {"vertex_ref_count", head.vertex_ref_count},
          {"triangle_count", head.triangle_count}};
}

Json mask_head_json(const octree::MaskPageHead& head) {
  return {{"page_number", head.page_number},
          {"ordinal", head.ordinal},
          {"octcode", fmt::format("0x{:016x}", head.octcode)},
          {"record_count", head.record_count},
          {"root_count", head.root_count},
          {"node_count", head.node_count},
          {"page_link_count", head.page_link_count},
          {"plain_count", head.plain_count},
          {"corners_count", head.corners_count},
          {"special_count", head.special_count},
          {"plane_count", head.plane_count},
          {"listed_count", head.listed_count},
          {"block_link_count", head.block_link_count}};
}

Json attribute_head_json(const octree::AttributePageHead& head) {
  return {{"page_number", head.page_number},
          {"ordinal", head.ordinal},
          {"octcode", fmt::format("0x{:016x}", head.octcode)},
          {"triangle_count", head.triangle_count}};
}

Json field_head_json(const octree::FieldPageHead& head) {
  return {{"page_number", head.page_number},
          {"ordinal", head.ordinal},
          {"octcode", fmt::format("0x{:016x}", head.octcode)},
          {"point_count", head.point_count}};
}

Json rows_json(const std::vector<StreamRow>& stream_rows) {
  Json rows = Json::array();
  std::uint64_t offset = 0;
  for (const StreamRow& row : stream_rows) {
    rows.push_back({{"stream", row.name},
                    {"offset", offset},
                    {"elements", row.elements},
                    {"bytes", row.bytes}});
    offset += row.bytes;
  }
  return rows;
}

template <class Streams>
Json streams_json(const FileParts& parts) {
  Streams streams;
  return parts.read(streams) ? rows_json(stream_rows(streams, parts.shape())) : Json::array();
}

Json vector_json(const std::array<float, 3>& values) { return {values[0], values[1], values[2]}; }

Json child_json(const FileParts& parts, const octree::Node& node, unsigned child) {
  const octree::LinkFormat links = parts.links();
  const octree::FloatBox box = child_box(node, child);
  const octree::Disc disc = child_disc(node, child);
  const std::uint32_t link = node.link[child];
  return {{"kind", octree::LinkFormat::is_leaf(link) ? "block" : "node"},
          {"page", links.page(link)},
          {"record", links.record(link)},
          {"box_lower", vector_json(box.lower)},
          {"box_upper", vector_json(box.upper)},
          {"normal", vector_json(disc.normal)},
          {"slab_lower", disc.slab_lower},
          {"slab_upper", disc.slab_upper},
          {"radius", disc.radius}};
}

std::string value_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

std::string object_text(std::string_view title, const Json& object) {
  std::string text = fmt::format("{}\n", title);
  for (const auto& [name, value] : object.items())
    text += fmt::format("  {:<18} {}\n", name, value_text(value));
  return text;
}

std::string numbers_text(const Json& vector) {
  std::string text;
  for (const Json& value : vector)
    text += fmt::format("{}{:.7g}", text.empty() ? "" : " ", value.get<double>());
  return text;
}

std::string_view kind_of(const PageRow& row) {
  if (row.mask) return "mask";
  if (row.field) return "field";
  if (row.attributes) return "attributes";
  return row.is_of_caps ? "caps" : "distance";
}

// A tree that is one block has no node.
unsigned subtree_count(const octree::PageHead& head) {
  return head.node_count == 0 ? 1U : head.root_count;
}

}  // namespace

std::string page_heading() {
  return fmt::format("{:>9} {:<24} {:>8} {:>6} {:>6} {:>9} {:>9} {:>9}\n", "page", "octcode",
                     "subtrees", "nodes", "blocks", "triangles", "raw", "stored");
}

std::string page_line(const PageRow& row) {
  const storage::PageEntry& entry = row.entry;
  const std::string key = fmt::format("{:>9} {:<24}", row.number, cell_text(entry.octcode));
  if (row.mask)
    return fmt::format("{} {:>32} {:>9} {:>9}\n", key,
                       fmt::format("mask of {} cells", row.mask->record_count), entry.raw_bytes,
                       entry.stored_bytes);
  if (row.field)
    return fmt::format("{} {:>32} {:>9} {:>9}\n", key,
                       fmt::format("field of {} points", row.field->point_count), entry.raw_bytes,
                       entry.stored_bytes);
  if (row.attributes)
    return fmt::format("{} {:>32} {:>9} {:>9}\n", key,
                       fmt::format("attributes of {}", row.attributes->triangle_count),
                       entry.raw_bytes, entry.stored_bytes);
  if (!row.head)
    return fmt::format("{} {:>32} {:>9} {:>9}\n", key, "unreadable", entry.raw_bytes,
                       entry.stored_bytes);
  const octree::PageHead& head = *row.head;
  return fmt::format("{} {:>8} {:>6} {:>6} {:>9} {:>9} {:>9}{}\n", key, subtree_count(head),
                     head.node_count, head.block_count, head.triangle_count, entry.raw_bytes,
                     entry.stored_bytes, row.is_of_caps ? " caps" : "");
}

Json page_json(const PageRow& row) {
  Json json = {{"page", row.number},
               {"readable", row.head || row.mask || row.field || row.attributes}};
  json.update(entry_json(row.entry));
  if (row.mask) json["mask_cells"] = row.mask->record_count;
  if (row.field) json["field_points"] = row.field->point_count;
  if (row.attributes) json["attribute_triangles"] = row.attributes->triangle_count;
  if (json["readable"]) json["kind"] = kind_of(row);
  if (!row.head) return json;
  const octree::PageHead& head = *row.head;
  json["subtrees"] = subtree_count(head);
  json["nodes"] = head.node_count;
  json["blocks"] = head.block_count;
  json["triangles"] = head.triangle_count;
  return json;
}

Json page_details(const FileParts& parts, const PageRow& row, bool decoded) {
  Json details = {{"page", row.number}, {"entry", entry_json(row.entry)}};
  if (row.head) {
    details["head"] = head_json(*row.head);
    details["streams"] = streams_json<octree::RawStreams>(parts);
  }
  if (row.mask) {
    details["head"] = mask_head_json(*row.mask);
    details["streams"] = streams_json<octree::MaskStreams>(parts);
  }
  if (row.field) {
    details["head"] = field_head_json(*row.field);
    details["streams"] = rows_json(stream_rows(*row.field));
  }
  if (row.attributes) {
    details["head"] = attribute_head_json(*row.attributes);
    details["streams"] =
        rows_json(stream_rows(*row.attributes, query::attribute_shape(parts.header()->model)));
  }
  if (row.head && decoded) details["nodes"] = nodes_json(parts, false);
  return details;
}

std::string page_details_text(const Json& details) {
  std::string text = object_text("entry in the directory", details["entry"]);
  if (details.contains("head")) {
    text += object_text("page head", details["head"]);
  }
  if (details.contains("streams")) {
    text += fmt::format("{:<18} {:>9} {:>9} {:>9}\n", "streams", "offset", "elements", "bytes");
    for (const Json& row : details["streams"])
      text += fmt::format("  {:<16} {:>9} {:>9} {:>9}\n", row["stream"].get<std::string>(),
                          row["offset"].get<std::uint64_t>(), row["elements"].get<std::uint64_t>(),
                          row["bytes"].get<std::uint64_t>());
  }
  if (details.contains("nodes")) text += nodes_text(details["nodes"]);
  return text;
}

Json nodes_json(const FileParts& parts, bool roots_only) {
  const FrameView frame = parts.frame();
  octree::RawStreams streams;
  const bool whole = parts.read(streams);
  Json nodes = Json::array();
  const std::uint32_t count = roots_only ? frame.header().root_count : frame.node_count();
  for (std::uint32_t i = 0; i < count; ++i) {
    const octree::Node& node = frame.node(i);
    Json json = {{"node", i}, {"height", node.height}};
    if (whole && i < frame.header().root_count) {
      const auto box = [&](std::size_t first) {
        const std::size_t at = 6 * std::size_t{i} + first;
        return vector_json(
            {streams.root_boxes[at], streams.root_boxes[at + 1], streams.root_boxes[at + 2]});
      };
      json["box_lower"] = box(0);
      json["box_upper"] = box(3);
    }
    json["children"] = Json::array();
    for (unsigned child = 0; child < node.child_count; ++child)
      json["children"].push_back(child_json(parts, node, child));
    nodes.push_back(std::move(json));
  }
  return nodes;
}

std::string nodes_text(const Json& nodes) {
  std::string text;
  for (const Json& node : nodes) {
    text += fmt::format("node {}, height {}", node["node"].dump(), node["height"].dump());
    if (node.contains("box_lower"))
      text += fmt::format(", box {} to {}", numbers_text(node["box_lower"]),
                          numbers_text(node["box_upper"]));
    text += '\n';
    for (const Json& child : node["children"])
      text += fmt::format(
          "  {:<5} {} of page {}: box {} to {}; normal {}, slab {:.7g} to {:.7g}, radius "
          "{:.7g}\n",
          child["kind"].get<std::string>(), child["record"].dump(), child["page"].dump(),
          numbers_text(child["box_lower"]), numbers_text(child["box_upper"]),
          numbers_text(child["normal"]), child["slab_lower"].get<double>(),
          child["slab_upper"].get<double>(), child["radius"].get<double>());
  }
  return text;
}

}  // namespace planetree::tools
