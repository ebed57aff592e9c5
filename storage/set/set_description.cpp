#include "storage/set/set_description.h"

#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

namespace planetree::storage {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kFormat = "planetree-set";
constexpr std::uint64_t kVersion = 1;
constexpr std::size_t kHexDigits = 16;  // of 64 bits

Error refusal(ErrorCode code, const char* cause) {
  return make_error(code, Error::kNowhere, Error::kNowhere, "%s", cause);
}

Error damaged(const char* cause) {
  return make_error(ErrorCode::kDamaged, Error::kNowhere, Error::kNowhere,
                    "the set file is damaged: %s; restore it from a copy or build it again", cause);
}

std::string hex(std::uint64_t value) {
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string text(kHexDigits, '0');
  for (std::size_t i = kHexDigits; i-- > 0; value >>= 4) text[i] = kDigits[value & 15];
  return text;
}

std::string hex(const Hash128& hash) { return hex(hash.high) + hex(hash.low); }

bool read_hex(std::string_view text, std::uint64_t& value) {
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  return read.ec == std::errc() && read.ptr == text.data() + text.size();
}

/// Reads values of one object of the set file. After a failure, `cause` says what is wrong.
class SetObject {
 public:
  SetObject(const Json& json, const char*& cause) : json_(json), cause_(cause) {}

  std::uint64_t number(const char* key, std::uint64_t most, const char* cause) const {
    const Json* const value = find(key);
    if (value && value->is_number_unsigned() && value->get<std::uint64_t>() <= most)
      return value->get<std::uint64_t>();
    cause_ = cause;
    return 0;
  }
  Hash128 hash(const char* key, const char* cause) const {
    const std::string text = this->text(key);
    Hash128 hash{};
    const bool good = text.size() == 2 * kHexDigits &&
                      read_hex(std::string_view(text).substr(0, kHexDigits), hash.high) &&
                      read_hex(std::string_view(text).substr(kHexDigits), hash.low);
    if (!good) cause_ = cause;
    return hash;
  }
  std::string text(const char* key) const {
    const Json* const value = find(key);
    return value && value->is_string() ? value->get<std::string>() : std::string();
  }
  std::optional<MemberBox> box(const char* key) const {
    const Json* const value = find(key);
    if (!value || value->is_null()) return {};
    MemberBox box{};
    if (value->is_array() && value->size() == 2 && corner((*value)[0], box.lower) &&
        corner((*value)[1], box.upper))
      return box;
    cause_ = "a box is not two lists of three numbers";
    return {};
  }
  const Json* find(const char* key) const {
    const auto found = json_.is_object() ? json_.find(key) : json_.end();
    return found == json_.end() ? nullptr : &*found;
  }

 private:
  static bool corner(const Json& json, double (&corner)[3]) {
    if (!json.is_array() || json.size() != 3) return false;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!json[axis].is_number()) return false;
      corner[axis] = json[axis].get<double>();
      if (!std::isfinite(corner[axis])) return false;
    }
    return true;
  }

  const Json& json_;
  const char*& cause_;
};

// The text of an address goes to the system and to servers, and into messages.
bool is_address(std::string_view text) {
  constexpr std::size_t kMaxAddress = 4096;
  if (text.empty() || text.size() > kMaxAddress) return false;
  for (const char c : text)
    if (static_cast<unsigned char>(c) < ' ' || c == '\x7f') return false;
  return true;
}

SetMember member_of(const Json& json, const char*& cause) {
  const SetObject object(json, cause);
  SetMember member;
  member.address = object.text("address");
  if (!is_address(member.address)) cause = "an address of a member is none";
  // All readers of JSON read such numbers exactly.
  member.bytes = object.number("bytes", std::uint64_t{1} << 53, "a length of a member is none");
  if (member.bytes == 0) cause = "a member is empty";
  member.hash = object.hash("hash", "a hash of a member is not 32 hexadecimal digits");
  member.pages = static_cast<std::uint32_t>(
      object.number("pages", ~std::uint32_t{0}, "a number of pages of a member is none"));
  member.box = object.box("box");
  return member;
}

Json json_of(const SetMember& member) {
  Json json = {{"address", member.address},
               {"bytes", member.bytes},
               {"hash", hex(member.hash)},
               {"pages", member.pages}};
  if (member.box)
    json["box"] = {{member.box->lower[0], member.box->lower[1], member.box->lower[2]},
                   {member.box->upper[0], member.box->upper[1], member.box->upper[2]}};
  return json;
}

}  // namespace

std::uint64_t SetDescription::bytes() const noexcept {
  std::uint64_t sum = 0;
  for (const SetMember& member : members) sum += member.bytes;
  return sum;
}

// A member has a line of its own, for people who read the set file.
std::string SetDescription::text() const {
  const auto line = [](const char* key, const std::string& value) {
    return "\n " + Json(key).dump() + ": " + value;
  };
  std::string list;
  for (const SetMember& member : members)
    list += (list.empty() ? "\n  " : ",\n  ") + json_of(member).dump();
  return "{" + line("format", Json(kFormat).dump()) + "," + line("version", Json(kVersion).dump()) +
         "," + line("content_id", Json(hex(content_id)).dump()) + "," +
         line("bytes", Json(bytes()).dump()) + "," + line("members", "[" + list + "\n ]\n}\n");
}

Result<SetDescription> SetDescription::read(const ByteSource& file) {
  if (file.size_bytes() > kMaxBytes)
    return refusal(ErrorCode::kNotPlanetree,
                   "this is too long for a set file; name a .ptreeset or .ptree file");
  std::vector<std::byte> text(static_cast<std::size_t>(file.size_bytes()));
  if (const auto read = file.read_at(0, text); !read) return read.error();
  return parse(text);
}

Result<SetDescription> SetDescription::parse(std::span<const std::byte> text) {
  const auto* const first = reinterpret_cast<const char*>(text.data());
  const Json json = Json::parse(first, first + text.size(), nullptr, false);
  const char* cause = nullptr;
  const SetObject object(json, cause);
  if (object.text("format") != kFormat)
    return refusal(ErrorCode::kNotPlanetree,
                   "this is not a set file; name a .ptreeset or .ptree file");
  if (object.number("version", kVersion, "") != kVersion || cause)
    return refusal(ErrorCode::kUnsupported,
                   "the set has another version; use a newer release of planetree");
  SetDescription description;
  description.content_id = object.hash("content_id", "its content id is not 32 hexadecimal digits");
  const Json* const members = object.find("members");
  if (!members || !members->is_array() || members->empty() || members->size() > kMaxMembers)
    return damaged("it does not have 1 to 256 members");
  for (const Json& member : *members) description.members.push_back(member_of(member, cause));
  if (object.number("bytes", ~std::uint64_t{0}, "its length is none") != description.bytes())
    cause = "its length is not that of the members";
  if (cause) return damaged(cause);
  return description;
}

}  // namespace planetree::storage
