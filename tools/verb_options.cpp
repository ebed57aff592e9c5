#include "tools/verb_options.h"

#include <fmt/format.h>

#include <cmath>

#include "octree/build/mesh_text.h"
#include "tools/size_text.h"

namespace planetree::tools {
namespace {

/// Adds an option whose text `complaint` judges (empty: it is good) before
/// `take` reads it.
template <class Complaint, class Take>
CLI::Option* add_checked(CLI::App& verb, const std::string& name, const std::string& help,
                         Complaint complaint, Take take) {
  return verb.add_option_function<std::string>(name, take, help)
      ->check(CLI::Validator([complaint](std::string& text) { return complaint(text); }, "", ""));
}

std::string length_complaint(const std::string& text, bool infinite) {
  double value = 0;
  if (octree::parse_real(text, value) && value >= 0 && (infinite || std::isfinite(value)))
    return {};
  return fmt::format("'{}' is not a length; give a number from 0 on, in model units",
                     octree::printable(text));
}

}  // namespace

CLI::Option* add_bytes_option(CLI::App& verb, const std::string& name, std::uint64_t& value,
                              const std::string& help) {
  const auto complaint = [](const std::string& text) {
    const auto bytes = parse_bytes(text);
    return bytes ? std::string() : std::string(bytes.error().text);
  };
  const auto take = [&value](const std::string& text) { value = *parse_bytes(text); };
  return add_checked(verb, name, help, complaint, take)->type_name("SIZE");
}

CLI::Option* add_count_option(CLI::App& verb, const std::string& name, std::uint64_t& value,
                              std::uint64_t most, const std::string& help) {
  const auto complaint = [most](const std::string& text) {
    const auto count = parse_count(text);
    if (!count) return std::string(count.error().text);
    return *count <= most ? std::string() : fmt::format("{} is too many; at most {}", *count, most);
  };
  const auto take = [&value](const std::string& text) { value = *parse_count(text); };
  return add_checked(verb, name, help, complaint, take)->type_name("N");
}

CLI::Option* add_length_option(CLI::App& verb, const std::string& name, double& value,
                               bool infinite, const std::string& help) {
  const auto complaint = [infinite](const std::string& text) {
    return length_complaint(text, infinite);
  };
  const auto take = [&value](const std::string& text) { octree::parse_real(text, value); };
  return add_checked(verb, name, help, complaint, take)->type_name("LENGTH");
}

}  // namespace planetree::tools
